// SPDX-License-Identifier: LGPL-2.1-or-later
// Detects a bottleneck that marks ECT(1) like ECT(0), as RFC 3168 says (RFC 9331, section 4.3).
#pragma once
#include "src/scream/model/recent_min.h"

namespace lidar::scream {

/// An L4S bottleneck marks each packet behind a long queue, whereas a classic one marks few
/// packets. So in rounds with marks, the queue that unmarked packets met distinguishes the two
/// kinds. The shortest delay of the last seconds is subtracted, because a longer route is not a
/// queue.
class ClassicEcn {
 public:
  void OnPacket(Time now, Duration qdelay, bool marked) {
    shortest_.Add(now, qdelay);
    if (marked) last_mark_ = now;
    if (marked || now - last_mark_ > kMarksLately) return;
    const Duration queue = qdelay - shortest_.value();
    unmarked_ += FromSeconds(Seconds(queue - unmarked_) * kGain);
    if (unmarked_ > kLongQueue) found_ = true;
    if (unmarked_ < kShort) found_ = false;
  }
  bool found() const { return found_; }

 private:
  static constexpr Duration kMarksLately = std::chrono::milliseconds(200);
  static constexpr Duration kLongQueue = std::chrono::milliseconds(5);
  static constexpr Duration kShort = std::chrono::microseconds(3500);
  static constexpr double kGain = 1.0 / 8192;
  RecentMin shortest_{std::chrono::seconds(1)};
  Time last_mark_{};
  Duration unmarked_{0};
  bool found_ = false;
};

}  // namespace lidar::scream
