// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the poses that fit relative poses best.
#pragma once
#include <vector>

#include "src/odometry/pose.h"

namespace lidar::slam {

/// `b` seen from `a` should be `pose`.
struct Edge {
  std::size_t a = 0;
  std::size_t b = 0;
  odometry::Pose pose;
  double sigma_m = 0.05;
  double sigma_rad = 0.005;
};

/// Changes all poses but the first, by Levenberg and Marquardt's method. Edges must join all poses.
/// Returns false if they do not.
bool Optimise(const std::vector<Edge>& edges, std::vector<odometry::Pose>* poses);

}  // namespace lidar::slam
