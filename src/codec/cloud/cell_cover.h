// SPDX-License-Identifier: LGPL-2.1-or-later
// Chooses the cells that represent points.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "src/codec/cloud/cell_list.h"

namespace lidar::codec::cloud {

using Point = std::array<float, 3>;

/// A grid of cubic cells. The middle of a cell is within the error of each point in the cell.
struct CellGrid {
  static constexpr float kFinest = 1e-5F;
  static constexpr float kCoarsest = 1e4F;

  float step_m = 0;

  /// Returns the coarsest grid for an error, with a little margin for the rounding of floats. If
  /// even the finest grid is too coarse, returns the finest grid, whose error_m() is then larger
  /// than `error_m`.
  static CellGrid ForError(double error_m);
  /// Returns the largest distance of a point from the middle of its cell.
  double error_m() const;
  /// Returns half of the number of cells along an axis.
  static double HalfOf(unsigned depth) {
    return static_cast<double>(std::uint64_t{1} << (depth - 1));
  }
  /// Returns the middle of a cell, as a decoder computes it.
  Point Middle(const CellPosition& cell, unsigned depth) const;
  /// Returns a coordinate of a cell's middle, rounded to a float.
  double Middle(std::uint32_t at, unsigned depth) const {
    return MiddleFromCentre(static_cast<double>(at) - HalfOf(depth));
  }
  /// Does the same as Middle(), for a cell whose lower edge is `cells` cells from the centre of the
  /// grid.
  double MiddleFromCentre(double cells) const {
    return static_cast<double>(static_cast<float>((cells + 0.5) * static_cast<double>(step_m)));
  }
  /// Returns the depth of a tree that has room for coordinates up to `farthest_m`. If no tree has
  /// room, the result is above kMostDepth.
  unsigned DepthFor(double farthest_m) const;
  /// Returns true if there is a tree that has room for coordinates up to `farthest_m`.
  bool Reaches(double farthest_m) const;
  /// Returns true if the middle of the point's cell, rounded to floats, is within the error of
  /// `point`. Reaches() must be true for the point.
  bool Holds(const Point& point) const;
  /// Returns a limit for the sum of a point's coordinates, without signs. Reaches() and Holds() are
  /// true for all points up to this limit.
  double SurelyHolds() const;
};

/// Points, grouped by cells.
struct CoveredPoints {
  CellList cells;
  std::vector<std::uint32_t> order;  // indices of the points, cell by cell
};

/// Assigns each point to its own cell. A tree of `depth` must have room for all points.
void CoverByOwnCells(const std::vector<Point>& points, const CellGrid& grid, unsigned depth,
                     CoveredPoints* covered);
/// Does the same as CoverByOwnCells(), but then merges cells with a neighbour whose middle is
/// within the error of all points in the cell. Fast, and nearly as good as CoverByFewCells().
void CoverByMergedCells(const std::vector<Point>& points, const CellGrid& grid, unsigned depth,
                        CoveredPoints* covered);
/// Assigns all points to few cells. Most points are within the error of several cells' middles. The
/// cell to which the most remaining points may belong gets all of them. This is repeated until no
/// point remains.
void CoverByFewCells(const std::vector<Point>& points, const CellGrid& grid, unsigned depth,
                     CoveredPoints* covered);

}  // namespace lidar::codec::cloud
