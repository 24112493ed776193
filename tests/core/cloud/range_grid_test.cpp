// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cloud/range_grid.h"

#include <gtest/gtest.h>

namespace lidar {
namespace {

TEST(RangeGrids, AreTheCoarsestThatKeepToAnError) {
  EXPECT_EQ(RangeGrid::ForError(0.02, 1).parts(), RangeGrid(1, 41).parts());
  EXPECT_EQ(RangeGrid::ForError(0.0195, 1).parts(), RangeGrid(1, 39).parts());
  EXPECT_EQ(RangeGrid::ForError(0.02, 8).parts(), RangeGrid(8, 6).parts());
  EXPECT_EQ(RangeGrid::ForError(0.0001, 8).parts(), RangeGrid(8, 1).parts());
  EXPECT_EQ(RangeGrid::ForError(-1, 3).parts(), RangeGrid(3, 1).parts());
}

TEST(RangeGrids, TakeAnyStepDownToTheSensorsUnit) {
  EXPECT_EQ(RangeGrid::ForStep(0.04, 1).parts(), RangeGrid(1, 40).parts());
  EXPECT_EQ(RangeGrid::ForStep(0.012, 8).parts(), 3 * RangeGrid::kParts / 2);
  EXPECT_DOUBLE_EQ(RangeGrid::ForStep(0.012, 8).step_m(), 0.012);
  EXPECT_EQ(RangeGrid::ForStep(0.001, 8).parts(), RangeGrid::kParts);
  EXPECT_EQ(RangeGrid::ForStep(1e9, 8).parts(), RangeGrid(8, RangeGrid::kMaxCells).parts());
}

TEST(RangeGrids, FindTheBinsOfManyRangesAsThoseOfOne) {
  for (const std::uint32_t unit : {1U, 3U, 4U, 8U, 1'000U})
    for (const std::uint32_t parts : {256U, 257U, 41U * 256, 65'535U * 256}) {
      const RangeGrid grid = RangeGrid::OfParts(unit, parts);
      const RangeGrid::BinFinder finder(grid);
      for (std::uint32_t range = 0; range < 70'000; ++range)
        for (const std::uint32_t r : {range, RangeGrid::kMaxRangeMm - range})
          ASSERT_EQ(finder.Of(r), grid.BinOf(r)) << r << " of " << unit << ", " << parts;
    }
}

TEST(RangeGrids, TurnManyBinsToRangesAsOneUpToTheLongestRange) {
  for (const std::uint32_t unit : {1U, 8U, 1'000U})
    for (const std::uint32_t parts : {256U, 257U, 41U * 256, 65'535U * 256}) {
      const RangeGrid grid = RangeGrid::OfParts(unit, parts);
      const std::uint32_t last = grid.BinOf(RangeGrid::kMaxRangeMm);
      const auto range_of = [&](std::uint32_t bin) {
        std::vector<std::int32_t> bins = {0, static_cast<std::int32_t>(bin)};
        return grid.ToRanges(&bins) ? static_cast<std::uint32_t>(bins[1]) : UINT32_MAX;
      };
      for (std::uint32_t bin = 1; bin < last; bin = 3 * bin + 1)
        ASSERT_EQ(range_of(bin), grid.RangeOf(bin)) << bin << " of " << unit << ", " << parts;
      EXPECT_EQ(range_of(last), grid.RangeOf(last)) << unit << ", " << parts;
      for (const std::uint32_t beyond : {last + 1, 2 * last, UINT32_MAX / 2, UINT32_MAX})
        EXPECT_EQ(range_of(beyond), UINT32_MAX) << beyond << " of " << unit << ", " << parts;
    }
}

class GridErrors : public ::testing::TestWithParam<std::uint32_t> {};

TEST_P(GridErrors, AreReachedAndNeverPassed) {
  const std::uint32_t unit = GetParam();
  for (std::uint32_t parts = 1; parts <= 44; ++parts) {
    const auto grid = RangeGrid::OfParts(unit, RangeGrid::kParts + parts * 139);
    ASSERT_TRUE(grid.IsValid());
    std::uint32_t worst = 0;
    // At larger ranges the pattern of the bins repeats.
    for (std::uint32_t r = unit; r < 26 * RangeGrid::kParts * unit; r += unit) {
      const std::uint32_t back = grid.RangeOf(grid.BinOf(r));
      ASSERT_GT(back, 0U) << "a return became a missing one";
      ASSERT_EQ(grid.BinOf(back / unit * unit), grid.BinOf(r)) << "not in the bin it stands for";
      worst = std::max(worst, back > r ? back - r : r - back);
    }
    EXPECT_DOUBLE_EQ(1e-3 * worst, grid.error_m()) << parts;
  }
}

TEST_P(GridErrors, StayWithinTheErrorAskedFor) {
  const std::uint32_t unit = GetParam();
  for (const double error : {0.0005, 0.0015, 0.0195, 0.02, 0.05, 1.0}) {
    const auto grid = RangeGrid::ForError(error, unit);
    EXPECT_LE(grid.error_m(), error);
    EXPECT_GT(RangeGrid::OfParts(unit, grid.parts() + RangeGrid::kParts).error_m(), error);
    // A grid with any finer step keeps to the error, too.
    for (std::uint32_t parts = RangeGrid::kParts; parts < grid.parts(); parts += 97)
      ASSERT_LE(RangeGrid::OfParts(unit, parts).error_m(), error + 1e-12) << parts;
  }
}
INSTANTIATE_TEST_SUITE_P(All, GridErrors, ::testing::Values(1U, 3U, 8U));

}  // namespace
}  // namespace lidar
