// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/odometry/motion_threshold.h"

#include <cmath>

namespace lidar::odometry {
namespace {

constexpr double kLeastMotion = 0.1;  // [m]: a sensor that stands still teaches nothing

}  // namespace

void MotionThreshold::Add(const Pose& correction) {
  // A rotation moves the farthest points most.
  const double moved =
      2 * max_range_m_ * std::sin(Angle(correction) / 2) + correction.position.norm();
  if (moved <= kLeastMotion) return;
  sum_of_squares_ += moved * moved;
  sigma_m_ = std::sqrt(sum_of_squares_ / ++count_);
}

}  // namespace lidar::odometry
