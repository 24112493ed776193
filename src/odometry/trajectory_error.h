// SPDX-License-Identifier: LGPL-2.1-or-later
// How far an estimated trajectory is from the true one: ATE and RPE (Sturm et al., 2012), and the
// drift of KITTI (Geiger et al., 2012).
#pragma once
#include <optional>

#include "src/odometry/trajectory.h"

namespace lidar::odometry {

struct TrajectoryError {
  std::size_t poses = 0;  // compared
  double ate_rmse_m = 0;  // of positions, after the best rigid alignment
  double ate_max_m = 0;
  double rpe_rmse_m = 0;  // of the motion over a second
  double rpe_rmse_deg = 0;
  double length_m = 0;          // of the true way
  double end_error_m = 0;       // of the last position, with the first second laid over each other
  std::optional<double> drift;  // mean error over stretches of 100 to 800 m, as part of them
};

/// Compares the poses of `estimate` that lie within the time of `truth` with the truth interpolated
/// at their times. None where fewer than three are left.
std::optional<TrajectoryError> Compare(const Trajectory& truth, const Trajectory& estimate);

}  // namespace lidar::odometry
