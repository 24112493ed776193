// SPDX-License-Identifier: LGPL-2.1-or-later
// Detects a bottleneck with classic ECN (RFC 3168), which marks ECT(1) packets like ECT(0) packets
// (RFC 9331, section 4.3).
#pragma once
#include "src/scream/model/recent_min.h"

namespace lidar::scream {

/// An L4S bottleneck marks every packet that waits in a long queue, whereas a classic bottleneck
/// marks only a few. In rounds with marks, the delay of unmarked packets is therefore short at an
/// L4S bottleneck and long at a classic one. The shortest delay of the last seconds is subtracted,
/// so that a longer route does not count as a queue.
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
