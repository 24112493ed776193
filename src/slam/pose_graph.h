// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the poses that agree best with measured relative poses.
#pragma once
#include <vector>

#include "src/odometry/pose.h"

namespace lidar::slam {

/// A relative pose: `pose` is the measured pose of `b` in the frame of `a`.
struct Edge {
  std::size_t a = 0;
  std::size_t b = 0;
  odometry::Pose pose;
  double sigma_m = 0.05;
  double sigma_rad = 0.005;
};

/// Optimises all poses except the first, with the Levenberg-Marquardt method. Returns false if
/// there are no edges, if an edge does not connect two of the poses, or if the equations have no
/// solution.
bool Optimise(const std::vector<Edge>& edges, std::vector<odometry::Pose>* poses);

}  // namespace lidar::slam
