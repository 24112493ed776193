// SPDX-License-Identifier: LGPL-2.1-or-later
// Measures the errors of a trajectory: ATE and RPE (Sturm et al., 2012), and the drift as defined
// by KITTI (Geiger et al., 2012).
#pragma once
#include <optional>

#include "src/odometry/trajectory.h"

namespace lidar::odometry {

struct TrajectoryError {
  std::size_t poses = 0;  // number of compared poses
  double ate_rmse_m = 0;  // error of positions, after the best rigid alignment
  double ate_max_m = 0;
  double rpe_rmse_m = 0;  // error of motions over one second
  double rpe_rmse_deg = 0;
  double length_m = 0;          // length of the true trajectory
  double end_error_m = 0;       // error of the last position, after the first second is aligned
  std::optional<double> drift;  // mean over stretches of 100 to 800 m, relative to their length
};

/// Compares the poses of `estimate` with `truth`, which is interpolated at their times. Returns
/// nothing if fewer than three of them are within the time of `truth`.
std::optional<TrajectoryError> Compare(const Trajectory& truth, const Trajectory& estimate);

}  // namespace lidar::odometry
