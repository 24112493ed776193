// SPDX-License-Identifier: LGPL-2.1-or-later
// When a viewer may have the next scan, by its acknowledgements of what it has drawn. TCP takes
// seconds of data for a slow link without a word; what is not acknowledged says how many.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>

#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar::viewer {

/// Named by the scan and its place in it.
struct SliceId {
  std::uint32_t scan = 0;
  std::uint32_t index = 0;
};

/// A scan begins while the unacknowledged bytes, at the rate of the acknowledgements, take no
/// longer than kSlack above the shortest delay seen. Times that are passed never go back.
class Pace {
 public:
  /// 0: no limit.
  explicit Pace(DataRate max_bitrate) : max_bitrate_(max_bitrate) {}

  bool MayBegin(Time now);
  /// What is not acknowledged takes too long.
  bool IsLate(Time now) const;
  void OnSent(Time now, SliceId slice, DataSize size);
  /// The viewer has drawn the slice, and all that was sent before it.
  void OnDrawn(Time now, SliceId slice);

  DataSize unacknowledged() const { return unacknowledged_; }
  DataRate rate() const { return rate_.empty() ? DataRate() : rate_.front().rate; }
  std::optional<Duration> shortest_delay() const { return shortest_; }

  /// The number of scans that a viewer may have before its first acknowledgement.
  static constexpr unsigned kFirstScans = 2;
  static constexpr Duration kSlack = std::chrono::milliseconds(100);
  /// Rates older than that count no more.
  static constexpr Duration kRateMemory = std::chrono::seconds(2);
  /// The shortest delay is measured anew this often, without other traffic.
  static constexpr Duration kDelayMemory = std::chrono::seconds(30);
  /// A viewer that owes an acknowledgement for so long is hidden, or gone.
  static constexpr Duration kPatience = std::chrono::seconds(2);

 private:
  struct Sent {
    SliceId slice;
    DataSize size;
    Time at;
    DataSize acknowledged_before;  // acknowledged in all when it was sent,
    Time acknowledged_at;          // and since when
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
  DataSize credit_;  // of max_bitrate; negative: overdrawn
  Time filled_{};
  std::deque<Sent> sent_;  // unacknowledged, in order
  DataSize unacknowledged_;
  DataSize acknowledged_;
  Time acknowledged_at_{};
  std::deque<Rate> rate_;  // the largest first, each later one newer
  std::optional<Duration> shortest_;
  Time shortest_at_{};
  unsigned begun_ = 0;
};

}  // namespace lidar::viewer
