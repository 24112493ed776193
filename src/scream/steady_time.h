// SPDX-License-Identifier: LGPL-2.1-or-later
// The caller's clock, made one that nobody sets back.
#pragma once
#include <algorithm>

#include "src/base/time.h"

namespace lidar::scream {

/// Threads may hand their times in a little out of order. A time from long before the latest one
/// means that the clock was set: what follows is counted on from there.
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
  /// Without learning anything.
  Time Peek(Time caller) const { return caller + shift_; }
  /// On the caller's clock again.
  Time ToCaller(Time time) const { return time == Time::max() ? time : time - shift_; }

 private:
  static constexpr Duration kDisorder = std::chrono::seconds(2);
  Duration shift_{0};
  Time latest_{};
};

}  // namespace lidar::scream
