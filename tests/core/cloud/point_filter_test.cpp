// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cloud/point_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <locale>

#include "tests/support/german_numbers.h"

namespace lidar {
namespace {

struct Point {
  float x, y, z;
  std::uint32_t id;
};

PointFields Fields() { return *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,id:U32:12"); }

/// Returns 2 rows of 6 columns. The points of a row are on a line along x and begin at 1 m. The
/// last point of the first row has no return.
std::vector<Point> Cloud() {
  std::vector<Point> points;
  for (std::uint32_t i = 0; i < 12; ++i)
    points.push_back({static_cast<float>(i % 6 + 1), i < 6 ? 0.0F : 1.0F, 0, i});
  points[5] = {0, 0, 0, 5};
  return points;
}

struct Filtered {
  std::vector<Point> points;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t first_column = 0;
  std::vector<std::uint32_t> Ids() const {
    std::vector<std::uint32_t> ids;
    for (const Point& p : points) ids.push_back(p.id);
    return ids;
  }
};

Filtered Filter(const PointFilterSettings& settings, const std::vector<Point>& cloud = Cloud(),
                std::uint32_t first_column = 0) {
  auto filter = PointFilter::Make(settings, Fields(), sizeof(Point));
  const auto out =
      filter->Apply({reinterpret_cast<const std::uint8_t*>(cloud.data()), 6, 2, first_column});
  Filtered filtered{std::vector<Point>(out.points.size() / sizeof(Point)), out.width, out.height,
                    out.first_column};
  if (!out.points.empty())
    std::memcpy(filtered.points.data(), out.points.data(), out.points.size());
  return filtered;
}

using Ids = std::vector<std::uint32_t>;

TEST(PointFilter, KeepsEveryNthRowAndColumnOfTheScan) {
  PointFilterSettings settings;
  settings.beam_step = 2;
  settings.column_step = 2;
  EXPECT_EQ(Filter(settings).Ids(), (Ids{0, 2, 4}));
  // The slice begins with column 3 of the scan. Only the columns 4, 6 and 8 of the scan are kept.
  const auto slice = Filter(settings, Cloud(), 3);
  EXPECT_EQ(slice.Ids(), (Ids{1, 3, 5}));
  EXPECT_EQ(slice.first_column, 2U);
  EXPECT_EQ(slice.height, 1U);
  EXPECT_EQ(slice.width, 3U);
}

TEST(PointFilter, ZerosWhatIsTooNearOrTooFarAndKeepsTheRows) {
  PointFilterSettings settings;
  settings.min_range_m = 1.2;
  settings.max_range_m = 4;
  const auto out = Filter(settings);
  EXPECT_EQ(out.Ids(), (Ids{0, 1, 2, 3, 0, 5, 6, 7, 8, 0, 0, 0}));
  EXPECT_EQ(out.points[0].x, 0);
  EXPECT_EQ(out.points[1].x, 2);
  EXPECT_EQ(out.width, 6U);
  EXPECT_EQ(out.height, 2U);
}

TEST(PointFilter, RemovesWhatIsOutsideOrInsideOfTheBox) {
  PointFilterSettings settings;
  settings.invalid = InvalidPoints::kRemove;
  settings.crop_box = {{2, -1, -1, 4, 0.5, 1}};
  EXPECT_EQ(Filter(settings).Ids(), (Ids{1, 2, 3}));
  EXPECT_EQ(Filter(settings).height, 1U);
  settings.crop_inside = true;
  EXPECT_EQ(Filter(settings).Ids(), (Ids{0, 4, 6, 7, 8, 9, 10, 11}));
}

TEST(PointFilter, KeepsOnePointOfEachVoxel) {
  PointFilterSettings settings;
  settings.invalid = InvalidPoints::kRemove;
  settings.voxel_size_m = 2;
  EXPECT_EQ(Filter(settings).Ids(), (Ids{0, 1, 3, 11}));
}

TEST(PointFilter, CountsAllThatIsFarAwayOnOneSideAsOneVoxel) {
  PointFilterSettings settings;
  settings.invalid = InvalidPoints::kRemove;
  settings.voxel_size_m = 0.01;
  std::vector<Point> cloud(12);
  for (std::uint32_t i = 0; i < 12; ++i) {
    const float far = static_cast<float>(i % 4 + 1) * (i % 2 == 0 ? 1e5F : -1e5F);
    cloud[i] = {i < 4 ? far : 0, i / 4 == 1 ? far : 0, i < 8 ? 0 : far, i};
  }
  EXPECT_EQ(Filter(settings, cloud).Ids(), (Ids{0, 1, 4, 5, 8, 9}));
}

TEST(PointFilter, KeepsWhatLiesOnALimit) {
  PointFilterSettings settings;
  settings.invalid = InvalidPoints::kRemove;
  settings.min_range_m = 2;
  settings.max_range_m = 4;
  auto cloud = Cloud();
  cloud.resize(6);
  cloud.resize(12, {0, 0, 0, 99});
  EXPECT_EQ(Filter(settings, cloud).Ids(), (Ids{1, 2, 3}));
  settings.max_range_m = 0;  // means that there is no limit
  EXPECT_EQ(Filter(settings, cloud).Ids(), (Ids{1, 2, 3, 4}));
  settings.min_range_m = 0;
  settings.crop_box = {{2, 0, 0, 3, 0, 0}};
  EXPECT_EQ(Filter(settings, cloud).Ids(), (Ids{1, 2}));
  settings.crop_inside = true;
  EXPECT_EQ(Filter(settings, cloud).Ids(), (Ids{0, 3, 4}));
}

TEST(PointFilter, MeasuresTheRangeFromTheSensorNotFromWhereItMovesPointsTo) {
  PointFilterSettings settings;
  settings.invalid = InvalidPoints::kRemove;
  settings.max_range_m = 2.5;
  settings.transform = ParseTransform("0,0,100, 0,0,0");
  EXPECT_EQ(Filter(settings).Ids(), (Ids{0, 1, 6, 7}));
}

TEST(PointFilter, RangeIsOfAllThreeCoordinates) {
  PointFilterSettings settings;
  settings.invalid = InvalidPoints::kRemove;
  settings.max_range_m = 6.9;
  auto cloud = std::vector<Point>(12, {0, 0, 0, 99});
  cloud[0] = {2, 3, 6, 0};  // at a range of 7 m
  cloud[1] = {2, 3, 5, 1};
  EXPECT_EQ(Filter(settings, cloud).Ids(), (Ids{1}));
  settings.min_range_m = 6.3;
  EXPECT_EQ(Filter(settings, cloud).Ids(), (Ids{}));
}

TEST(PointFilter, VoxelsOnBothSidesOfZeroAreTwo) {
  PointFilterSettings settings;
  settings.invalid = InvalidPoints::kRemove;
  settings.voxel_size_m = 1;
  auto cloud = std::vector<Point>(12, {0, 0, 0, 99});
  cloud[0] = {0.4F, 0, 0, 0};
  cloud[1] = {-0.4F, 0, 0, 1};
  cloud[2] = {0.4F, -0.4F, 0, 2};
  cloud[3] = {0.4F, 0, -0.4F, 3};
  cloud[4] = {0.6F, 0.1F, 0.1F, 4};  // in the voxel of point 0
  cloud[5] = {-0.6F, 0, 0, 5};       // in the voxel of point 1
  EXPECT_EQ(Filter(settings, cloud).Ids(), (Ids{0, 1, 2, 3}));
}

TEST(PointFilter, EachCloudHasItsOwnVoxelsAndAllCountInWhatIsRemoved) {
  PointFilterSettings settings;
  settings.invalid = InvalidPoints::kRemove;
  settings.voxel_size_m = 100;
  auto filter = PointFilter::Make(settings, Fields(), sizeof(Point));
  const auto cloud = Cloud();
  const CloudRows rows{reinterpret_cast<const std::uint8_t*>(cloud.data()), 6, 2, 0};
  for (std::uint64_t n = 1; n <= 2; ++n) {
    EXPECT_EQ(filter->Apply(rows).width, 1U);
    EXPECT_EQ(filter->removed(), 10 * n);  // The cloud has eleven returns.
  }
}

TEST(PointFilter, LeavesNoColumnOfASliceBetweenTwoSteps) {
  PointFilterSettings settings;
  settings.column_step = 8;
  // The slice has the columns 1 to 6. The next column to be kept is 8.
  const auto out = Filter(settings, Cloud(), 1);
  EXPECT_EQ(out.width, 0U);
  EXPECT_EQ(out.height, 2U);
  settings.column_step = 7;
  const auto last = Filter(settings, Cloud(), 2);  // Column 7 is the last column of the slice.
  EXPECT_EQ(last.Ids(), (Ids{5, 11}));
  EXPECT_EQ(last.first_column, 1U);
  settings.column_step = 1;
  settings.beam_step = 3;
  EXPECT_EQ(Filter(settings).height, 1U);
}

TEST(PointFilter, MovesPointsBeforeItCrops) {
  PointFilterSettings settings;
  settings.invalid = InvalidPoints::kRemove;
  settings.transform = ParseTransform("0,0,1, 0,0,90");
  settings.crop_box = {{-10, 5.5, 0.5, 10, 6.5, 1.5}};
  const auto out = Filter(settings);
  ASSERT_EQ(out.Ids(), (Ids{11}));
  EXPECT_NEAR(out.points[0].x, -1, 1e-6);
  EXPECT_NEAR(out.points[0].y, 6, 1e-6);
  EXPECT_NEAR(out.points[0].z, 1, 1e-6);
}

TEST(PointFilter, APoseIsTheTransformOfItsQuaternion) {
  // The angle is 2 * acos(0.5), a third of a turn, about (1, 1, 1). This moves x to y, y to z and z
  // to x.
  const Transform t = FromPose({7, 8, 9}, {0.5, 0.5, 0.5, 0.5});
  EXPECT_EQ(t, (Transform{0, 0, 1, 7, 1, 0, 0, 8, 0, 1, 0, 9, 0, 0, 0, 1}));
  const double half = std::sqrt(0.5);
  const Transform turn = FromPose({1, 2, 3}, {0, 0, half, half});
  const Transform angles = *ParseTransform("1,2,3, 0,0,90");
  for (std::size_t i = 0; i < turn.size(); ++i) EXPECT_NEAR(turn[i], angles[i], 1e-12);
}

TEST(PointFilter, TakesTheTransformFromWhereThePoseHasPutPoints) {
  PointFilterSettings settings;
  settings.has_pose = true;
  settings.transform = ParseTransform("0,0,0, 0,0,90");
  auto filter = PointFilter::Make(settings, Fields(), sizeof(Point));
  const Point point = {2, 0, 0, 7};
  const auto out = filter->Apply(
      {reinterpret_cast<const std::uint8_t*>(&point), 1, 1, 0, FromPose({10, 0, 0}, {0, 0, 0, 1})});
  Point moved{};
  ASSERT_EQ(out.points.size(), sizeof moved);
  std::memcpy(&moved, out.points.data(), sizeof moved);
  EXPECT_NEAR(moved.x, 0, 1e-5);
  EXPECT_NEAR(moved.y, 12, 1e-5);
}

TEST(PointFilter, PointsThatAPosePutsNowhereAreRemoved) {
  PointFilterSettings settings;
  settings.has_pose = true;
  settings.voxel_size_m = 1;
  settings.invalid = InvalidPoints::kRemove;
  auto filter = PointFilter::Make(settings, Fields(), sizeof(Point));
  const Point point = {2, 0, 0, 7};
  const double nowhere = std::numeric_limits<double>::quiet_NaN();
  const auto out = filter->Apply({reinterpret_cast<const std::uint8_t*>(&point), 1, 1, 0,
                                  FromPose({nowhere, 0, 0}, {0, 0, 0, 1})});
  EXPECT_TRUE(out.points.empty());
  EXPECT_EQ(filter->removed(), 1U);
}

TEST(PointFilter, PointsWithoutAReturnFollowThePolicy) {
  auto cloud = Cloud();
  cloud[0].x = std::numeric_limits<float>::quiet_NaN();
  PointFilterSettings settings;
  settings.max_range_m = 100;
  const auto kept = Filter(settings, cloud);
  EXPECT_TRUE(std::isnan(kept.points[0].x));
  EXPECT_EQ(kept.points[5].x, 0);
  settings.invalid = InvalidPoints::kZero;
  const auto zero = Filter(settings, cloud);
  EXPECT_EQ(zero.points[0].x, 0);
  settings.invalid = InvalidPoints::kNan;
  const auto nan = Filter(settings, cloud);
  EXPECT_TRUE(std::isnan(nan.points[0].x) && std::isnan(nan.points[5].z));
  EXPECT_EQ(nan.points[5].id, 0U);
  EXPECT_EQ(nan.points[6].x, 1);
  EXPECT_EQ(nan.points[6].id, 6U);
  settings.invalid = InvalidPoints::kRemove;
  EXPECT_EQ(Filter(settings, cloud).Ids(), (Ids{1, 2, 3, 4, 6, 7, 8, 9, 10, 11}));
}

TEST(PointFilter, APointIsAReturnUnlessACoordinateIsNoNumberOrAllAreZero) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float far = std::numeric_limits<float>::infinity();
  PointFilterSettings settings;
  settings.invalid = InvalidPoints::kRemove;
  const std::vector<Point> cloud = {{nan, 1, 1, 0}, {1, nan, 1, 1}, {1, 1, nan, 2}, {far, 1, 1, 3},
                                    {1, far, 1, 4}, {1, 1, far, 5}, {1, 0, 0, 6},   {0, 1, 0, 7},
                                    {0, 0, 1, 8},   {0, 0, 0, 9},   {-1, 0, 0, 10}, {0, 0, -1, 11}};
  EXPECT_EQ(Filter(settings, cloud).Ids(), (Ids{6, 7, 8, 10, 11}));
}

TEST(PointFilter, NeedsCoordinatesForWhatIsAboutThem) {
  const auto fields = *PointFields::Parse("intensity:F32:0");
  PointFilterSettings settings;
  settings.column_step = 2;
  EXPECT_TRUE(PointFilter::Make(settings, fields, 4));
  std::vector<PointFilterSettings> about_them(7);
  about_them[0].max_range_m = 5;
  about_them[1].min_range_m = 1;
  about_them[2].has_pose = true;
  about_them[3].transform = kIdentity;
  about_them[4].crop_box = {{-1, -1, -1, 1, 1, 1}};
  about_them[5].voxel_size_m = 0.1;
  about_them[6].invalid = InvalidPoints::kZero;
  for (std::size_t i = 0; i < about_them.size(); ++i) {
    EXPECT_FALSE(PointFilter::Make(about_them[i], fields, 4)) << i;
    EXPECT_TRUE(PointFilter::Make(about_them[i], Fields(), 16)) << i;
  }
}

TEST(PointFilter, NumbersAreReadWithAPointWhateverLocaleTheProgramSets) {
  const std::locale before = std::locale::global({std::locale(), new test::GermanNumbers});
  const auto numbers = ParseNumbers("0.5,-1.25 1000");
  std::locale::global(before);
  EXPECT_EQ(numbers, (std::vector<double>{0.5, -1.25, 1000}));
}

TEST(PointFilter, TransformsAreReadStrictly) {
  const auto rows = ParseTransform("1 2 3 4,5 6 7 8,9 10 11 12,0 0 0 1");
  EXPECT_EQ(rows, (Transform{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 0, 0, 0, 1}));
  // The numbers are metres, and then degrees about x, y and z. The turn about z is applied last.
  const auto turned = ParseTransform("1,2,3, 90,0,90");
  ASSERT_TRUE(turned);
  const Transform expected = {0, 0, 1, 1, 1, 0, 0, 2, 0, 1, 0, 3, 0, 0, 0, 1};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR((*turned)[i], expected[i], 1e-9);
  const auto pitched = ParseTransform("0,0,0, 0,90,0");
  EXPECT_NEAR((*pitched)[2], 1, 1e-9);
  EXPECT_NEAR((*pitched)[8], -1, 1e-9);
  for (const char* bad : {"1 2 3", "1 2 3 4 5", "1 2 3 4 5 6 7", "1,2,3,4,5,x", "1,2,3,4,5,6m",
                          "nan,0,0,0,0,0", "1e999,0,0,0,0,0"})
    EXPECT_FALSE(ParseTransform(bad)) << bad;
}

}  // namespace
}  // namespace lidar
