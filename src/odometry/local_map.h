// SPDX-License-Identifier: LGPL-2.1-or-later
// The surroundings as a sparse grid of points, to which new scans are aligned.
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
  double radius_m = 100;  // points farther from the sensor are dropped
};

/// Memory is bounded by the radius: each cube holds kMaxPoints points at most, of 24 bytes.
/// Add() and FindNearest() take constant time a point, Forget() a time linear in the cubes.
class LocalMap {
 public:
  static constexpr std::size_t kMaxPoints = 20;  // per cube

  explicit LocalMap(const LocalMapSettings& settings);

  bool empty() const { return index_.empty(); }
  std::size_t voxels() const { return index_.size(); }
  std::size_t CountPoints() const;
  /// Returns all points, in any order.
  Points Collect() const;

  /// Adds the points that are not close to a point of the map.
  void Add(const Points& points) { Add(points, {}); }
  /// `normals`, of unit length, belong to the first points; the other points have no normal.
  void Add(const Points& points, const Points& normals);
  /// Drops the cubes beyond the radius around `center`.
  void Forget(const Eigen::Vector3d& center);

  /// The point of the map that is nearest to a given point.
  struct Neighbour {
    Eigen::Vector3d point;
    bool has_normal = false;
    /// A unit vector, added with the point or computed from the surface of the point's cube.
    Eigen::Vector3d normal;
  };
  /// Finds the nearest point within `reach_m` of `point`. The search covers the cube of `point` and
  /// the adjacent cubes, so it misses some neighbours if `reach_m` exceeds a cube's edge. A cube's
  /// normal is computed again only after the cube has changed.
  std::optional<Neighbour> FindNearest(const Eigen::Vector3d& point, double reach_m);

 private:
  struct Block {
    std::array<Eigen::Vector3f, kMaxPoints> points;   // relative to the corner of the cube
    std::array<Eigen::Vector3f, kMaxPoints> normals;  // as added with the points; zero: no normal
    std::uint32_t count = 0;
    std::uint32_t counted = 0;  // number of points when the normal was computed
    bool has_normal = false;
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  };
  Eigen::Vector3d CornerOf(const Voxel& voxel) const;
  Block* BlockAt(const Voxel& voxel);
  Block* FindBlock(const Voxel& voxel);
  void UpdateNormal(const Voxel& voxel, Block* block);

  LocalMapSettings settings_;
  double spacing_m_;  // least distance between points of one cube
  tsl::robin_map<Voxel, std::uint32_t, VoxelHash> index_;
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> free_;
};

}  // namespace lidar::odometry
