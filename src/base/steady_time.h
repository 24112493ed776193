// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts the caller's clock to a clock that never jumps back.
#pragma once
#include <algorithm>

#include "src/base/time.h"

namespace lidar {

/// A clock that does not jump back when the caller's clock is set. Threads may pass their times
/// slightly out of order. If a time is far before the latest time, the caller's clock was set. The
/// steady time then continues from its latest value.
class SteadyTime {
 public:
  Time From(Time caller) {
    Time time = caller + shift_;
    if (time + kDisorder < latest_) {
      shift_ += latest_ - time;
      time = latest_;
    }
    latest_ = std::max(latest_, time);
    return time;
  }
  /// Converts the caller's time to steady time, without a change of state.
  Time Peek(Time caller) const { return caller + shift_; }
  /// Converts a steady time back to the caller's time.
  Time ToCaller(Time time) const { return time == Time::max() ? time : time - shift_; }

 private:
  static constexpr Duration kDisorder = std::chrono::seconds(2);
  Duration shift_{0};
  Time latest_{};
};

}  // namespace lidar
