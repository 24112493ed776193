// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/odometry/voxel_grid.h"

#include <tsl/robin_set.h>

namespace lidar::odometry {

Points Downsample(const Points& points, double size_m) {
  tsl::robin_set<Voxel, VoxelHash> taken;
  taken.reserve(points.size() / 4);
  Points kept;
  kept.reserve(points.size() / 4);
  for (const Eigen::Vector3d& point : points)
    if (taken.insert(VoxelOf(point, size_m)).second) kept.push_back(point);
  return kept;
}

}  // namespace lidar::odometry
