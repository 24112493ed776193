// SPDX-License-Identifier: LGPL-2.1-or-later
// Estimates the usual error of predictions with constant velocity. The search distance of the
// alignment depends on this error.
#pragma once
#include <cmath>

#include "src/odometry/pose.h"

namespace lidar::odometry {

/// The standard deviation of the corrections that alignments make (KISS-ICP, section III-C).
class MotionThreshold {
 public:
  explicit MotionThreshold(double max_range_m) : max_range_m_(max_range_m) {}

  /// `correction` is the motion from the predicted pose to the aligned pose, in the sensor's frame.
  void Add(const Pose& correction) {
    // A rotation moves the most distant points by the greatest distance.
    const double moved =
        2 * max_range_m_ * std::sin(Angle(correction) / 2) + correction.position.norm();
    if (moved <= kLeastMotion) return;
    sum_of_squares_ += moved * moved;
    sigma_m_ = std::sqrt(sum_of_squares_ / ++count_);
  }
  double sigma_m() const { return sigma_m_; }

 private:
  static constexpr double kLeastMotion = 0.1;  // smaller corrections are ignored [m]

  double max_range_m_;
  double sum_of_squares_ = 0;
  int count_ = 0;
  double sigma_m_ = 2;  // initial value, used until the first correction
};

}  // namespace lidar::odometry
