// SPDX-License-Identifier: LGPL-2.1-or-later
// Measures the rate of data over a sliding window.
#pragma once
#include <algorithm>
#include <deque>

#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar {

class RateMeter {
 public:
  explicit RateMeter(Duration window) : window_(window) {}
  void set_window(Duration window) { window_ = window; }
  void Add(Time now, DataSize size) {
    if (events_.empty()) first_ = std::min(first_, now);
    events_.push_back({now, size});
    sum_ += size;
    Expire(now);
  }
  /// Returns the average rate over the window, or over the time since the first event if that is
  /// shorter.
  DataRate Rate(Time now) {
    Expire(now);
    if (first_ == Time::max()) return DataRate();
    return sum_ / std::clamp(now - first_, kMinWindow, std::max(kMinWindow, window_));
  }

 private:
  struct Event {
    Time time;
    DataSize size;
  };
  static constexpr Duration kMinWindow = std::chrono::milliseconds(10);
  void Expire(Time now) {
    while (!events_.empty() && events_.front().time <= now - window_) {
      sum_ -= events_.front().size;
      events_.pop_front();
    }
  }
  Duration window_;
  Time first_ = Time::max();
  std::deque<Event> events_;
  DataSize sum_;
};

}  // namespace lidar
