// SPDX-License-Identifier: LGPL-2.1-or-later
// Divides space into cubes: finds the cube of a point, and keeps only one point in each cube.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "src/odometry/pose.h"

namespace lidar::odometry {

/// The index of a cube along each axis.
struct Voxel {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;
  bool operator==(const Voxel& o) const { return x == o.x && y == o.y && z == o.z; }
};

struct VoxelHash {
  /// Uses the three primes of Teschner et al., "Optimized Spatial Hashing", 2003.
  std::size_t operator()(const Voxel& v) const {
    return static_cast<std::uint32_t>(v.x) * std::size_t{73856093} ^
           static_cast<std::uint32_t>(v.y) * std::size_t{19349663} ^
           static_cast<std::uint32_t>(v.z) * std::size_t{83492791};
  }
};

/// Returns the cube that contains `point`. `size_m` is the edge length of a cube. Points beyond
/// 2^31 cubes count as in the outermost cube.
inline Voxel VoxelOf(const Eigen::Vector3d& point, double size_m) {
  const auto index = [size_m](double c) {
    return static_cast<std::int32_t>(
        std::clamp(std::floor(c / size_m), -2147483648.0, 2147483647.0));
  };
  return {index(point.x()), index(point.y()), index(point.z())};
}

/// Returns the first point in each cube, in the order of `points`.
Points Downsample(const Points& points, double size_m);
/// Returns the indices of the points that Downsample() returns.
std::vector<std::size_t> FirstOfEachCube(const Points& points, double size_m);

}  // namespace lidar::odometry
