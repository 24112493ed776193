// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/cell_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "src/codec/cloud/cell_cover.h"
#include "src/codec/mixing/binary_coder.h"

namespace lidar::codec::cloud {
namespace {

/// Returns points of a floor and of a wall that crosses the floor. Some points occur twice.
std::vector<Point> FloorAndWall(std::size_t count) {
  std::mt19937 random(3);
  const auto metres = [&] { return static_cast<float>(random() % 100'000) * 1e-4F - 5; };
  std::vector<Point> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back(i % 3 == 0 ? Point{3, metres(), metres()} : Point{metres(), metres(), -1.7F});
    if (i % 50 == 0) points.push_back(points.back());
  }
  return points;
}

TEST(CellTree, GivesBackCellsAndCounts) {
  for (const double error_m : {0.02, 0.3, 20.0}) {
    const auto points = FloorAndWall(3'000);
    const CellGrid grid = CellGrid::ForError(error_m);
    CoveredPoints covered;
    CoverByOwnCells(points, grid, grid.DepthFor(5), &covered);
    const CellList before = covered.cells;
    std::vector<std::uint8_t> bytes;
    mixing::BinaryEncoder encoder(&bytes);
    CellTree tree;
    ASSERT_TRUE(tree.Code(&covered.cells, {points.size(), SIZE_MAX}, &encoder));
    encoder.Finish();
    const std::size_t nodes = tree.nodes();
    CellList cells;
    cells.depth = before.depth;
    mixing::BinaryDecoder decoder({bytes.data(), bytes.size()});
    ASSERT_TRUE(tree.Code(&cells, {points.size(), nodes}, &decoder));
    EXPECT_TRUE(decoder.AtEnd());
    EXPECT_EQ(cells.codes, before.codes);
    EXPECT_EQ(cells.counts, before.counts);
    // The decoder refuses a tree that has one node or one point more than its limit.
    for (const CellLimits& limits :
         {CellLimits{points.size(), nodes - 1}, CellLimits{points.size() - 1, nodes}}) {
      mixing::BinaryDecoder again({bytes.data(), bytes.size()});
      EXPECT_FALSE(tree.Code(&cells, limits, &again));
    }
  }
}

class Cover : public ::testing::TestWithParam<decltype(&CoverByOwnCells)> {};

/// Expects that each point belongs to exactly one cell, and that the middle of the cell is at most
/// 5 cm away from the point.
void ExpectAllWithinTheError(const std::vector<Point>& points, decltype(&CoverByOwnCells) cover) {
  const CellGrid grid = CellGrid::ForError(0.05);
  EXPECT_LE(grid.error_m(), 0.05);
  float farthest = 0;
  for (const Point& p : points)
    for (const float c : p) farthest = std::max(farthest, std::abs(c));
  const unsigned depth = grid.DepthFor(static_cast<double>(farthest));
  ASSERT_LE(depth, kMostDepth);
  CoveredPoints covered;
  cover(points, grid, depth, &covered);
  std::vector<int> seen(points.size(), 0);
  std::size_t at = 0;
  for (std::size_t i = 0; i < covered.cells.codes.size(); ++i) {
    if (i > 0) {
      EXPECT_LT(covered.cells.codes[i - 1], covered.cells.codes[i]);
    }
    const Point middle = grid.Middle(PositionOf(covered.cells.codes[i]), depth);
    for (std::uint32_t k = 0; k < covered.cells.counts[i]; ++k, ++at) {
      const Point& p = points[covered.order[at]];
      ++seen[covered.order[at]];
      EXPECT_LE(std::hypot(middle[0] - p[0], middle[1] - p[1], middle[2] - p[2]), 0.05F);
    }
  }
  EXPECT_EQ(seen, std::vector<int>(points.size(), 1));
}

TEST_P(Cover, GivesEachPointACellWhoseMiddleIsWithinTheError) {
  ExpectAllWithinTheError(FloorAndWall(3'000), GetParam());
}
TEST_P(Cover, DistinguishesAllCellsOfTheDeepestTree) {
  // The largest tree has 2^21 cells along each axis. The two points are 2^20 cells apart.
  const float apart = CellGrid::ForError(0.05).step_m * static_cast<float>(1 << 20);
  for (const std::size_t axis : {0U, 1U, 2U}) {
    Point near{1, 2, 3};
    Point far = near;
    near[axis] -= apart / 2;
    far[axis] += apart / 2;
    ExpectAllWithinTheError({near, far}, GetParam());
  }
}
INSTANTIATE_TEST_SUITE_P(All, Cover,
                         ::testing::Values(&CoverByOwnCells, &CoverByMergedCells,
                                           &CoverByFewCells));

TEST(Cover, TakesFewerCellsWhereItMayChoose) {
  const auto points = FloorAndWall(30'000);
  const CellGrid grid = CellGrid::ForError(0.05);
  CoveredPoints own;
  CoveredPoints few;
  CoverByOwnCells(points, grid, grid.DepthFor(5), &own);
  CoveredPoints merged;
  CoverByFewCells(points, grid, grid.DepthFor(5), &few);
  CoverByMergedCells(points, grid, grid.DepthFor(5), &merged);
  EXPECT_LT(merged.cells.codes.size(), 0.85 * static_cast<double>(own.cells.codes.size()));
  EXPECT_LT(few.cells.codes.size(), 0.8 * static_cast<double>(own.cells.codes.size()));
}

}  // namespace
}  // namespace lidar::codec::cloud
