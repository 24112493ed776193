// SPDX-License-Identifier: LGPL-2.1-or-later
// Measures the errors of a trajectory: ATE and RPE (Sturm et al., 2012), and KITTI's drift (Geiger
// et al., 2012).
#pragma once
#include <optional>

#include "src/odometry/trajectory.h"

namespace lidar::odometry {

struct TrajectoryError {
  std::size_t poses = 0;  // number of poses compared
  double ate_rmse_m = 0;  // of positions, after the best rigid alignment
  double ate_max_m = 0;
  double rpe_rmse_m = 0;  // of the motions over one second
  double rpe_rmse_deg = 0;
  double length_m = 0;          // of the true trajectory
  double end_error_m = 0;       // of the last position, after the first seconds are aligned
  std::optional<double> drift;  // mean over stretches of 100 to 800 m, as part of their length
};

/// Compares `estimate` with `truth`, interpolated at the estimate's times. Returns nothing if fewer
/// than three poses lie within the time of `truth`.
std::optional<TrajectoryError> Compare(const Trajectory& truth, const Trajectory& estimate);

}  // namespace lidar::odometry
