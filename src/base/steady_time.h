// SPDX-License-Identifier: LGPL-2.1-or-later
// Turns the caller's clock into a steady one.
#pragma once
#include <algorithm>

#include "src/base/time.h"

namespace lidar {

/// Threads may pass their times slightly out of order. A time far before the latest one means that
/// the clock was set: the steady time then continues from its latest value.
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
  /// Converts a time without a change of state.
  Time Peek(Time caller) const { return caller + shift_; }
  /// Converts a steady time back to the caller's clock.
  Time ToCaller(Time time) const { return time == Time::max() ? time : time - shift_; }

 private:
  static constexpr Duration kDisorder = std::chrono::seconds(2);
  Duration shift_{0};
  Time latest_{};
};

}  // namespace lidar
