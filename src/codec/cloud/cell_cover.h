// SPDX-License-Identifier: LGPL-2.1-or-later
// Chooses the cells that stand for points.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "src/codec/cloud/cell_list.h"

namespace lidar::codec::cloud {

using Point = std::array<float, 3>;

/// Cubes, so small that a point is within the error of the middle of its own.
struct CellGrid {
  static constexpr float kFinest = 1e-5F;
  static constexpr float kCoarsest = 1e4F;

  float step_m = 0;

  /// The coarsest grid for an error, if any is that fine, with a little room for what floats round
  /// off.
  static CellGrid ForError(double error_m);
  /// The largest distance of a point from the middle of its own cell.
  double error_m() const;
  /// The middle of a cell, as decoders give it.
  Point Middle(const CellPosition& cell, unsigned depth) const;
  /// The depth of a tree that holds all coordinates up to `farthest_m`; above kMostDepth for none.
  unsigned DepthFor(double farthest_m) const;
  /// Whether some depth holds all coordinates up to `farthest_m`.
  bool Reaches(double farthest_m) const;
  /// Whether floats are fine enough, so far away, for the error. The point is in reach of some
  /// depth.
  bool Holds(const Point& point) const;
};

/// Points by cells, and which they are.
struct CoveredPoints {
  CellList cells;
  std::vector<std::uint32_t> order;  // indices of the points, cell by cell
};

/// Gives each point the cell that it lies in. The grid has a depth for all points.
void CoverByOwnCells(const std::vector<Point>& points, const CellGrid& grid, unsigned depth,
                     CoveredPoints* covered);
/// Gives all points to few cells: most points are within the error of several middles, and the
/// cell that has most of the remaining points takes all of them.
void CoverByFewCells(const std::vector<Point>& points, const CellGrid& grid, unsigned depth,
                     CoveredPoints* covered);

}  // namespace lidar::codec::cloud
