// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/odometry/voxel_grid.h"

#include <tsl/robin_set.h>

namespace lidar::odometry {

std::vector<std::size_t> FirstOfEachCube(const Points& points, double size_m) {
  tsl::robin_set<Voxel, VoxelHash> taken;
  taken.reserve(points.size() / 4);
  std::vector<std::size_t> kept;
  kept.reserve(points.size() / 4);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (taken.insert(VoxelOf(points[i], size_m)).second) kept.push_back(i);
  return kept;
}

Points Downsample(const Points& points, double size_m) {
  Points kept;
  for (const std::size_t i : FirstOfEachCube(points, size_m)) kept.push_back(points[i]);
  return kept;
}

}  // namespace lidar::odometry
