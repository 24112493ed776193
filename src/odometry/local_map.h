// SPDX-License-Identifier: LGPL-2.1-or-later
// The surroundings as a sparse grid of points: what new scans are aligned to.
#pragma once
#include <tsl/robin_map.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "src/odometry/voxel_grid.h"

namespace lidar::odometry {

struct LocalMapSettings {
  double voxel_size_m = 1;
  double radius_m = 100;  // what is farther from the sensor is forgotten
};

/// Memory is bounded by the radius: each cube holds kMaxPoints points at most, of 24 bytes.
/// Add() and FindNearest() take constant time a point, Forget() a time linear in the cubes.
class LocalMap {
 public:
  static constexpr std::size_t kMaxPoints = 20;  // in a cube

  explicit LocalMap(const LocalMapSettings& settings);

  bool empty() const { return index_.empty(); }
  std::size_t voxels() const { return index_.size(); }
  std::size_t CountPoints() const;
  /// All points, in no order.
  Points Collect() const;

  /// Adds the points that are not close to one that is there.
  void Add(const Points& points) { Add(points, {}); }
  /// `normals`, of unit length, are those of the first points; the others have none.
  void Add(const Points& points, const Points& normals);
  /// Drops the cubes that are farther than the radius from `center`.
  void Forget(const Eigen::Vector3d& center);

  /// What of the map is nearest to a point.
  struct Neighbour {
    Eigen::Vector3d point;
    bool has_normal = false;
    /// Has unit length. It came with the point, or is that of the surface on which the points of
    /// its cube lie.
    Eigen::Vector3d normal;
  };
  /// The nearest point within `reach_m` of `point`; cubes next to the point's own are searched, so
  /// a reach beyond one cube finds most neighbours, not all. Normals are kept until a cube changes.
  std::optional<Neighbour> FindNearest(const Eigen::Vector3d& point, double reach_m);

 private:
  struct Block {
    std::array<Eigen::Vector3f, kMaxPoints> points;   // relative to the corner of the cube
    std::array<Eigen::Vector3f, kMaxPoints> normals;  // that came with them; zero: none
    std::uint32_t count = 0;
    std::uint32_t counted = 0;  // as the normal was computed
    bool has_normal = false;
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  };
  Eigen::Vector3d CornerOf(const Voxel& voxel) const;
  Block* BlockAt(const Voxel& voxel);
  Block* FindBlock(const Voxel& voxel);
  void UpdateNormal(const Voxel& voxel, Block* block);

  LocalMapSettings settings_;
  double spacing_m_;  // between points of one cube, at least
  tsl::robin_map<Voxel, std::uint32_t, VoxelHash> index_;
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> free_;
};

}  // namespace lidar::odometry
