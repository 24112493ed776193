// SPDX-License-Identifier: LGPL-2.1-or-later
// Estimates the usual error of a constant-velocity prediction. It sets the reach of the search.
#pragma once
#include <cmath>

#include "src/odometry/pose.h"

namespace lidar::odometry {

/// The standard deviation of the corrections by registration: KISS-ICP, section III-C.
class MotionThreshold {
 public:
  explicit MotionThreshold(double max_range_m) : max_range_m_(max_range_m) {}

  /// `correction` leads from the predicted pose to the found one, in the sensor's frame.
  void Add(const Pose& correction) {
    // A rotation moves the farthest points most.
    const double moved =
        2 * max_range_m_ * std::sin(Angle(correction) / 2) + correction.position.norm();
    if (moved <= kLeastMotion) return;
    sum_of_squares_ += moved * moved;
    sigma_m_ = std::sqrt(sum_of_squares_ / ++count_);
  }
  double sigma_m() const { return sigma_m_; }

 private:
  static constexpr double kLeastMotion = 0.1;  // [m]: smaller steps are no motion

  double max_range_m_;
  double sum_of_squares_ = 0;
  int count_ = 0;
  double sigma_m_ = 2;  // start value, used until the first correction
};

}  // namespace lidar::odometry
