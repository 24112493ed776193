// SPDX-License-Identifier: LGPL-2.1-or-later
// A map of the surroundings as a sparse grid of points. New scans are aligned to it.
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
  double radius_m = 100;  // points that are farther from the sensor are dropped
};

/// A map of limited size: it has no points beyond the radius, and at most kMaxPoints points of 24
/// bytes in a cube. Add() and FindNearest() take constant time for each point. Forget() takes time
/// linear in the number of cubes.
class LocalMap {
 public:
  static constexpr std::size_t kMaxPoints = 20;  // in a cube

  explicit LocalMap(const LocalMapSettings& settings);

  bool empty() const { return index_.empty(); }
  std::size_t voxels() const { return index_.size(); }
  std::size_t CountPoints() const;
  /// Returns all points, in no particular order.
  Points Collect() const;

  /// Adds points, except those that are close to a point of the map.
  void Add(const Points& points) { Add(points, {}); }
  /// Adds points with normals of unit length. `normals[i]` is the normal of `points[i]`. Points
  /// beyond the end of `normals` have no normal.
  void Add(const Points& points, const Points& normals);
  /// Drops the cubes that are farther from `center` than the radius.
  void Forget(const Eigen::Vector3d& center);

  /// The nearest point of the map.
  struct Neighbour {
    Eigen::Vector3d point;
    bool has_normal = false;
    /// A unit vector. It was added with the point, or computed from the points in the point's cube.
    Eigen::Vector3d normal;
  };
  /// Finds the point of the map that is nearest to `point`, within `reach_m`. The search covers the
  /// cube of `point` and the adjacent cubes, so it may miss points if `reach_m` exceeds the edge
  /// length of a cube. The normal of a cube is cached until the cube changes.
  std::optional<Neighbour> FindNearest(const Eigen::Vector3d& point, double reach_m);

 private:
  struct Block {
    std::array<Eigen::Vector3f, kMaxPoints> points;   // relative to the corner of the cube
    std::array<Eigen::Vector3f, kMaxPoints> normals;  // normals of these points; zero if unknown
    std::uint32_t count = 0;
    std::uint32_t counted = 0;  // value of `count` when `normal` was computed
    bool has_normal = false;
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  };
  Eigen::Vector3d CornerOf(const Voxel& voxel) const;
  Block* BlockAt(const Voxel& voxel);
  Block* FindBlock(const Voxel& voxel);
  void UpdateNormal(const Voxel& voxel, Block* block);

  LocalMapSettings settings_;
  double spacing_m_;  // least distance between two points in a cube
  tsl::robin_map<Voxel, std::uint32_t, VoxelHash> index_;
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> free_;
};

}  // namespace lidar::odometry
