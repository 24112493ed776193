// SPDX-License-Identifier: LGPL-2.1-or-later
// Decides when a viewer gets the next scan, from its acknowledgements of drawn slices. TCP silently
// buffers seconds of data for a slow link; unacknowledged bytes show how much.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>

#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar::viewer {

/// A slice, named by the scan and its place in it.
struct SliceId {
  std::uint32_t scan = 0;
  std::uint32_t index = 0;
};

/// A scan may begin if the unacknowledged bytes arrive within the shortest delay plus kSlack, at
/// the rate of recent acknowledgements. Times must not go back.
class Pace {
 public:
  /// `max_bitrate` of 0: no limit.
  explicit Pace(DataRate max_bitrate) : max_bitrate_(max_bitrate) {}

  bool MayBegin(Time now);
  /// Returns true if the unacknowledged bytes take too long.
  bool IsLate(Time now) const;
  void OnSent(Time now, SliceId slice, DataSize size);
  /// Notes that the viewer has drawn the slice, and all that was sent before it.
  void OnDrawn(Time now, SliceId slice);

  DataSize unacknowledged() const { return unacknowledged_; }
  std::size_t unacknowledged_slices() const { return sent_.size(); }
  DataRate rate() const { return rate_.empty() ? DataRate() : rate_.front().rate; }
  std::optional<Duration> shortest_delay() const { return shortest_; }

  /// Number of scans that a viewer gets before its first acknowledgement.
  static constexpr unsigned kFirstScans = 2;
  static constexpr Duration kSlack = std::chrono::milliseconds(100);
  /// Older rates do not count.
  static constexpr Duration kRateMemory = std::chrono::seconds(2);
  /// Interval at which the shortest delay is measured anew, without other traffic.
  static constexpr Duration kDelayMemory = std::chrono::seconds(30);
  /// A viewer that owes an acknowledgement for this time is hidden or gone.
  static constexpr Duration kPatience = std::chrono::seconds(2);

 private:
  struct Sent {
    SliceId slice;
    DataSize size;
    Time at;
    DataSize acknowledged_before;  // all that was acknowledged when the slice was sent
    Time acknowledged_at;          // when the last of that was acknowledged
    bool alone = false;            // no other traffic was under way
  };
  struct Rate {
    DataRate rate;
    Time at;
  };
  void Spend(Time now, DataSize size);
  void Refill(Time now);
  void LearnDelay(Time now, Duration delay, bool alone);
  void LearnRate(Time now, DataRate rate);

  DataRate max_bitrate_;
  DataSize credit_;  // bytes allowed by max_bitrate; negative: overdrawn
  Time filled_{};
  std::deque<Sent> sent_;  // unacknowledged, in order
  DataSize unacknowledged_;
  DataSize acknowledged_;
  Time acknowledged_at_{};
  std::deque<Rate> rate_;  // highest first; each later rate is lower and newer
  std::optional<Duration> shortest_;
  Time shortest_at_{};
  unsigned begun_ = 0;
};

}  // namespace lidar::viewer
