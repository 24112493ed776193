// SPDX-License-Identifier: LGPL-2.1-or-later
// Chooses the cells that represent points.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "src/codec/cloud/cell_list.h"

namespace lidar::codec::cloud {

using Point = std::array<float, 3>;

/// A grid of cubes. A point is within the error of its cube's middle.
struct CellGrid {
  static constexpr float kFinest = 1e-5F;
  static constexpr float kCoarsest = 1e4F;

  float step_m = 0;

  /// Returns the coarsest grid for an error, with a little room for the rounding of floats. The
  /// error_m() of the finest grid may be larger than `error_m`.
  static CellGrid ForError(double error_m);
  /// Largest distance of a point from the middle of its cell.
  double error_m() const;
  /// Half of the cells along an axis.
  static double HalfOf(unsigned depth) {
    return static_cast<double>(std::uint64_t{1} << (depth - 1));
  }
  /// Middle of a cell, as decoders compute it.
  Point Middle(const CellPosition& cell, unsigned depth) const;
  /// Coordinate of the middle, rounded to a float.
  double Middle(std::uint32_t at, unsigned depth) const {
    return MiddleFromCentre(static_cast<double>(at) - HalfOf(depth));
  }
  /// The same for a cell that begins `cells` cells from the centre of the grid.
  double MiddleFromCentre(double cells) const {
    return static_cast<double>(static_cast<float>((cells + 0.5) * static_cast<double>(step_m)));
  }
  /// Depth of a tree that holds all coordinates up to `farthest_m`; above kMostDepth if no tree
  /// does.
  unsigned DepthFor(double farthest_m) const;
  /// Returns true if a depth holds all coordinates up to `farthest_m`.
  bool Reaches(double farthest_m) const;
  /// Returns true if floats are fine enough for the error at `point`. A tree must reach the point.
  bool Holds(const Point& point) const;
  /// Limit of the sum of a point's coordinates: up to it, floats are fine enough.
  double SurelyHolds() const;
};

/// Points, grouped by cells.
struct CoveredPoints {
  CellList cells;
  std::vector<std::uint32_t> order;  // indices of the points, cell by cell
};

/// Gives each point its own cell. A tree of `depth` must hold all points.
void CoverByOwnCells(const std::vector<Point>& points, const CellGrid& grid, unsigned depth,
                     CoveredPoints* covered);
/// Does the same, but then joins a cell with a neighbour whose middle is within the error of all
/// points of the cell. Fast, and nearly as good as CoverByFewCells().
void CoverByMergedCells(const std::vector<Point>& points, const CellGrid& grid, unsigned depth,
                        CoveredPoints* covered);
/// Gives all points to few cells. Most points are within the error of several middles; the cell
/// with the most remaining points gets all of these.
void CoverByFewCells(const std::vector<Point>& points, const CellGrid& grid, unsigned depth,
                     CoveredPoints* covered);

}  // namespace lidar::codec::cloud
