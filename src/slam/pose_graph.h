// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the poses that fit given relative poses best.
#pragma once
#include <vector>

#include "src/odometry/pose.h"

namespace lidar::slam {

/// `pose` is the measured pose of `b` in the frame of `a`.
struct Edge {
  std::size_t a = 0;
  std::size_t b = 0;
  odometry::Pose pose;
  double sigma_m = 0.05;
  double sigma_rad = 0.005;
};

/// Changes all poses but the first, by the method of Levenberg and Marquardt. Returns false if
/// edges do not connect all poses.
bool Optimise(const std::vector<Edge>& edges, std::vector<odometry::Pose>* poses);

}  // namespace lidar::slam
