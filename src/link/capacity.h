// SPDX-License-Identifier: LGPL-2.1-or-later
// The capacity of a link over time.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar::link {

/// A rate that is constant between changes, from time 0 of the link. It repeats, or keeps its last
/// rate for ever. A rate of zero is a gap: no packet moves until its end.
class Capacity {
 public:
  static Capacity Constant(DataRate rate);
  /// Has each rate for the time `each`. Afterwards it repeats all rates, or keeps the last one.
  static Capacity Steps(const std::vector<DataRate>& rates, Duration each, bool repeat = false);
  /// Parses a line `time_s rate_mbps` for each change, with ascending times; `#` starts a comment.
  /// The first rate holds from 0. In a repeating trace the last rate lasts as long as the rate
  /// before it. Returns nothing for other text; `error` then has the place and the reason.
  static std::optional<Capacity> ParseTrace(std::string_view text, bool repeat, std::string* error);

  /// Returns the same capacity from `start` on. In a repeating capacity, the part before `start`
  /// comes last.
  Capacity StartingAt(Duration start) const;

  /// Sets the rate to 0 from `from` to `until`, which are link times and do not repeat.
  Capacity& AddOutage(Duration from, Duration until);

  DataRate RateAt(Duration t) const;
  /// Returns the first time after `t` at which the rate may change, or Duration::max() for never.
  Duration NextChange(Duration t) const;
  /// Returns the time at which the last bit of `size` leaves if the first leaves at `start`, or
  /// Duration::max() for never.
  Duration Finish(Duration start, DataSize size) const;
  /// Returns the bytes that the link carries from `from` to `until`.
  DataSize Between(Duration from, Duration until) const;

  static constexpr std::size_t kMaxChanges = 1000000;
  static constexpr double kMaxMbps = 1e6;

 private:
  struct Change {
    Duration at;
    DataRate rate;
  };
  struct Outage {
    Duration from;
    Duration until;
  };
  struct Segment {
    DataRate rate;
    Duration end;
  };
  Segment SegmentAt(Duration t) const;
  Segment ScheduledAt(Duration t) const;
  void RepeatEvery(Duration period);

  std::vector<Change> changes_;  // the first one is at 0
  Duration period_{0};           // 0: the rates do not repeat
  double bits_per_period_ = 0;
  std::vector<Outage> outages_;
  Duration last_outage_{0};
};

}  // namespace lidar::link
