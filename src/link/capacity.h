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

/// A rate over time, from time 0 of the link, which is constant between changes. The rates repeat,
/// or the last rate lasts for ever. A rate of zero is a gap: no packet moves until the end of the
/// gap.
class Capacity {
 public:
  static Capacity Constant(DataRate rate);
  /// Returns a capacity that has each of `rates` for the time `each`. It then repeats all rates, or
  /// keeps the last rate.
  static Capacity Steps(const std::vector<DataRate>& rates, Duration each, bool repeat = false);
  /// Parses a text with one line `time_s rate_mbps` for each change, with ascending times. `#`
  /// starts a comment. The first rate applies from time 0. In a repeating trace, the last rate
  /// lasts as long as the rate before it. If the text is wrong, sets `error` to the line and the
  /// reason, and returns nothing.
  static std::optional<Capacity> ParseTrace(std::string_view text, bool repeat, std::string* error);

  /// Returns the part of the capacity from `start` on, with `start` as its time 0. In a repeating
  /// capacity, the part before `start` comes last.
  Capacity StartingAt(Duration start) const;

  /// Sets the rate to 0 from `from` to `until`. Both are times of the link, and the outage does not
  /// repeat.
  Capacity& AddOutage(Duration from, Duration until);

  DataRate RateAt(Duration t) const;
  /// Returns the first time after `t` at which the rate may change, or Duration::max() if it never
  /// changes.
  Duration NextChange(Duration t) const;
  /// Returns the time at which the last bit of `size` is sent if the first bit is sent at `start`,
  /// or Duration::max() if that never happens.
  Duration Finish(Duration start, DataSize size) const;
  /// Returns the number of bytes that the link can carry from `from` to `until`.
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
