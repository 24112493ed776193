// SPDX-License-Identifier: LGPL-2.1-or-later
// Decides when the next scan is sent to a viewer. TCP silently buffers seconds of data for a slow
// link. The number of unacknowledged bytes shows how much data is buffered.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>

#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar::viewer {

/// The name of a slice: the number of its scan, and its index in the scan.
struct SliceId {
  std::uint32_t scan = 0;
  std::uint32_t index = 0;
};

/// The pace of a viewer. A scan may begin if the unacknowledged bytes, at the rate of recent
/// acknowledgements, arrive within the shortest delay plus kSlack. Times must not decrease.
class Pace {
 public:
  /// If `max_bitrate` is 0, there is no limit.
  explicit Pace(DataRate max_bitrate) : max_bitrate_(max_bitrate) {}

  bool MayBegin(Time now);
  /// Returns true if the unacknowledged bytes would take too long to arrive.
  bool IsLate(Time now) const;
  void OnSent(Time now, SliceId slice, DataSize size);
  /// Notes that the viewer has drawn the slice, and all slices that were sent before it.
  void OnDrawn(Time now, SliceId slice);

  DataSize unacknowledged() const { return unacknowledged_; }
  std::size_t unacknowledged_slices() const { return sent_.size(); }
  DataRate rate() const { return rate_.empty() ? DataRate() : rate_.front().rate; }
  std::optional<Duration> shortest_delay() const { return shortest_; }

  /// The number of scans that are sent to a viewer before its first acknowledgement.
  static constexpr unsigned kFirstScans = 2;
  static constexpr Duration kSlack = std::chrono::milliseconds(100);
  /// The time after which a measured rate is no longer used.
  static constexpr Duration kRateMemory = std::chrono::seconds(2);
  /// The interval at which the shortest delay is measured again, without other traffic.
  static constexpr Duration kDelayMemory = std::chrono::seconds(30);
  /// A viewer that has not acknowledged a slice for this time is hidden or gone.
  static constexpr Duration kPatience = std::chrono::seconds(2);

 private:
  struct Sent {
    SliceId slice;
    DataSize size;
    Time at;
    DataSize acknowledged_before;  // bytes that were acknowledged when the slice was sent
    Time acknowledged_at;          // when the last of these bytes were acknowledged
    bool alone = false;            // no other slice was unacknowledged
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
  DataSize credit_;  // bytes that max_bitrate allows now; negative if exceeded
  Time filled_{};
  std::deque<Sent> sent_;  // unacknowledged slices in the order of sending
  DataSize unacknowledged_;
  DataSize acknowledged_;
  Time acknowledged_at_{};
  std::deque<Rate> rate_;  // the highest first; each rate is lower and newer than those before
  std::optional<Duration> shortest_;
  Time shortest_at_{};
  unsigned begun_ = 0;
};

}  // namespace lidar::viewer
