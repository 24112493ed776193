// SPDX-License-Identifier: LGPL-2.1-or-later
// Whether the bottleneck marks as RFC 3168 says, ECT(1) like ECT(0) (RFC 9331, section 4.3).
#pragma once
#include <algorithm>

#include "src/base/time.h"

namespace lidar::scream {

/// Behind a long queue an L4S bottleneck marks every packet, a classic one few. So the queue of
/// unmarked packets, in rounds that saw marks, tells them apart. A route that became longer is no
/// queue: what the shortest delay of the last seconds shows is taken off.
class ClassicEcn {
 public:
  void OnPacket(Time now, Duration qdelay, bool marked) {
    if (now - lowest_since_ >= kLowestWindow) {
      previous_lowest_ = lowest_;
      lowest_ = qdelay;
      lowest_since_ = now;
    }
    lowest_ = std::min(lowest_, qdelay);
    if (marked) last_mark_ = now;
    if (marked || now - last_mark_ > kMarksLately) return;
    const Duration queue = qdelay - std::min(lowest_, previous_lowest_);
    unmarked_ += FromSeconds(Seconds(queue - unmarked_) * kGain);
    if (unmarked_ > kLong) found_ = true;
    if (unmarked_ < kShort) found_ = false;
  }
  bool found() const { return found_; }

 private:
  static constexpr Duration kLowestWindow = std::chrono::seconds(1);
  static constexpr Duration kMarksLately = std::chrono::milliseconds(200);
  static constexpr Duration kLong = std::chrono::milliseconds(5);
  static constexpr Duration kShort = std::chrono::microseconds(3500);
  static constexpr double kGain = 1.0 / 8192;
  Duration lowest_ = Duration::max();
  Duration previous_lowest_ = Duration::max();
  Time lowest_since_{};
  Time last_mark_{};
  Duration unmarked_{0};
  bool found_ = false;
};

}  // namespace lidar::scream
