// SPDX-License-Identifier: LGPL-2.1-or-later
// How much a link can carry, over time.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar::link {

/// A rate that is constant between changes. It starts with the link, at 0, and either repeats or
/// keeps its last rate for ever. A rate of zero is a gap: no packet moves until it ends.
class Capacity {
 public:
  static Capacity Constant(DataRate rate);
  /// Each rate for `each`; afterwards the last one stays, or all of them come again.
  static Capacity Steps(const std::vector<DataRate>& rates, Duration each, bool repeat = false);
  /// Parses a `time_s rate_mbps` a line, times rising, `#` starts a comment. The first rate holds
  /// from 0. If it repeats, the last rate lasts as long as the one before it. Returns nothing for
  /// other text; `error` then says where and why.
  static std::optional<Capacity> ParseTrace(std::string_view text, bool repeat, std::string* error);

  /// The same link from `start` on. If it repeats, the part before `start` comes at the end.
  Capacity StartingAt(Duration start) const;

  /// A link that is down from `from` to `until`, whatever the rate said; absolute, not repeated.
  Capacity& AddOutage(Duration from, Duration until);

  DataRate RateAt(Duration t) const;
  /// The first time after `t` at which the rate may be another one; Duration::max() for never.
  Duration NextChange(Duration t) const;
  /// When the last bit of `size` leaves, the first being sent at `start`; Duration::max() for
  /// never.
  Duration Finish(Duration start, DataSize size) const;
  /// Bytes that can be carried from `from` to `until`.
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

  std::vector<Change> changes_;  // the first at 0
  Duration period_{0};           // 0: does not repeat
  double bits_per_period_ = 0;
  std::vector<Outage> outages_;
  Duration last_outage_{0};
};

}  // namespace lidar::link
