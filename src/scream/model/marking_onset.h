// SPDX-License-Identifier: LGPL-2.1-or-later
// Estimates the queue delay at which the bottleneck starts to mark.
#pragma once
#include "src/base/time.h"

namespace lidar::scream {

/// Takes a low quantile of the queue delays of marked packets. Arrival times of reports are coarse
/// and the base delay is their minimum, so the resolution is about a millisecond.
class MarkingOnset {
 public:
  explicit MarkingOnset(Duration initial) : value_(initial) {}

  void OnMark(Duration qdelay) {
    value_ += FromSeconds(Seconds(qdelay - value_) * (qdelay < value_ ? kDown : kUp));
  }
  Duration value() const { return value_; }

 private:
  static constexpr double kDown = 1.0 / 32;
  static constexpr double kUp = 1.0 / 128;
  Duration value_;
};

}  // namespace lidar::scream
