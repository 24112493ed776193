// SPDX-License-Identifier: LGPL-2.1-or-later
// The minimum of durations in the current and the previous window. Older durations are forgotten.
#pragma once
#include <algorithm>
#include <utility>

#include "src/base/time.h"

namespace lidar::scream {

class RecentMin {
 public:
  explicit RecentMin(Duration window) : window_(window) {}

  /// Adds a duration. Returns by how much `d` is below the previous minimum, or 0 if there was no
  /// minimum.
  Duration Add(Time now, Duration d) {
    if (now - since_ >= window_) {
      previous_ = std::exchange(latest_, Duration::max());
      since_ = now;
    }
    const Duration before = value();
    latest_ = std::min(latest_, d);
    return before == Duration::max() ? Duration{0} : before - value();
  }
  void Forget() { latest_ = previous_ = Duration::max(); }
  /// Returns the minimum, or Duration::max() before the first Add().
  Duration value() const { return std::min(latest_, previous_); }

 private:
  Duration window_;
  Time since_{};
  Duration latest_ = Duration::max();
  Duration previous_ = Duration::max();
};

}  // namespace lidar::scream
