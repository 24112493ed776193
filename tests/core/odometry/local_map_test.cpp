// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/odometry/local_map.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <random>

namespace lidar::odometry {
namespace {

Points RandomPoints(std::size_t count, double edge_m) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> anywhere(-edge_m, edge_m);
  Points points;
  for (std::size_t i = 0; i < count; ++i)
    points.emplace_back(anywhere(random), anywhere(random), anywhere(random));
  return points;
}

TEST(Downsample, KeepsTheFirstPointOfEachCube) {
  const Points points = {{0.1, 0.1, 0.1}, {0.9, 0.9, 0.9}, {-0.1, 0.1, 0.1}, {1.1, 0.1, 0.1}};
  const Points kept = Downsample(points, 1);
  ASSERT_EQ(kept.size(), 3U);
  EXPECT_EQ(kept[0], points[0]);
  EXPECT_EQ(kept[1], points[2]);  // The coordinate 0 is on a border between cubes.
  EXPECT_EQ(kept[2], points[3]);
}

TEST(LocalMap, FindsTheNearestPointWithinACube) {
  LocalMap map({1, 100});
  const Points points = RandomPoints(5000, 5);
  map.Add(points);
  const Points kept = map.Collect();
  for (const Eigen::Vector3d& asked : RandomPoints(300, 5)) {
    double nearest = 1;  // Points at 1 m or more are beyond the reach.
    for (const Eigen::Vector3d& point : kept) nearest = std::min(nearest, (point - asked).norm());
    const auto found = map.FindNearest(asked, 1);
    ASSERT_EQ(found.has_value(), nearest < 1);
    if (found) {
      EXPECT_NEAR((found->point - asked).norm(), nearest, 1e-5);
    }
  }
}

TEST(LocalMap, FindsNothingBeyondTheReach) {
  LocalMap map({1, 100});
  map.Add({{0.5, 0.5, 0.5}});
  EXPECT_TRUE(map.FindNearest({0.5, 0.5, 0.9}, 0.5));
  EXPECT_FALSE(map.FindNearest({0.5, 0.5, 0.9}, 0.3));
  EXPECT_FALSE(map.FindNearest({7, 0, 0}, 10));
}

TEST(LocalMap, KeepsPointsApartAndFewInACube) {
  LocalMap map({1, 100});
  for (int i = 0; i < 5; ++i) map.Add(RandomPoints(5000, 1));
  EXPECT_EQ(map.voxels(), 8U);
  EXPECT_LE(map.CountPoints(), 8 * LocalMap::kMaxPoints);
  const std::size_t before = map.CountPoints();
  map.Add(map.Collect());
  EXPECT_EQ(map.CountPoints(), before);
}

TEST(LocalMap, ForgetsWhatIsFarAndUsesItsPlaceAgain) {
  LocalMap map({1, 20});
  for (int x = 0; x < 10'000; x += 5) {
    map.Add({{double(x), 0.5, 0.5}, {double(x), 3.5, 0.5}});
    map.Forget({double(x), 0, 0});
    ASSERT_LE(map.voxels(), 12U);
  }
  EXPECT_TRUE(map.FindNearest({9995, 0.5, 0.5}, 1));
  EXPECT_FALSE(map.FindNearest({0, 0.5, 0.5}, 1));
}

/// Returns the bytes of the heap that are in use. Returns a constant if the allocator is not
/// glibc's.
std::size_t HeapInUse() {
  const auto info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

TEST(LocalMap, NeedsNoMoreMemoryAfterALongerWay) {
  LocalMap map({1, 20});
  const auto drive = [&map](int from, int to) {
    for (int x = from; x < to; ++x) {
      map.Add({{double(x), 0.5, 0.5}, {double(x), 3.5, 0.5}});
      map.Forget({double(x), 0, 0});
    }
  };
  drive(0, 1'000);
  const std::size_t before = HeapInUse();
  drive(1'000, 10'000);
  EXPECT_LT(HeapInUse(), before + 100'000);
}

TEST(LocalMap, APlaceThatIsUsedAgainHasNoneOfItsOldPoints) {
  LocalMap map({1, 20});
  map.Add({{0.2, 0.5, 0.5}});
  map.Forget({100, 0, 0});
  map.Add({{100.8, 0.5, 0.5}});
  EXPECT_EQ(map.CountPoints(), 1U);
  EXPECT_FALSE(map.FindNearest({100.2, 0.5, 0.5}, 0.1));
}

TEST(LocalMap, KnowsTheNormalOfASurface) {
  LocalMap map({1, 100});
  Points floor;
  for (double x = 0; x < 4; x += 0.25)
    for (double y = 0; y < 4; y += 0.25) floor.emplace_back(x, y, 0.3 + 0.001 * std::sin(9 * x));
  map.Add(floor);
  const auto found = map.FindNearest({2.1, 2.1, 0.5}, 1);
  ASSERT_TRUE(found);
  ASSERT_TRUE(found->has_normal);
  EXPECT_GT(std::abs(found->normal.z()), 0.999);
}

TEST(LocalMap, LearnsANewNormalFromNewPoints) {
  LocalMap map({1, 100});
  Points line;
  for (double x = 0.05; x < 1; x += 0.24)
    for (const double y : {0.05, 0.5, 0.95}) line.emplace_back(x, y, 0.5);
  map.Add(line);
  ASSERT_TRUE(map.FindNearest({0.5, 0.5, 0.5}, 1)->has_normal);
  Points across;
  for (double x = 0.05; x < 1; x += 0.24)
    for (const double z : {0.05, 0.95}) across.emplace_back(x, 0.5, z);
  map.Add(across);
  EXPECT_FALSE(map.FindNearest({0.5, 0.5, 0.5}, 1)->has_normal);
}

TEST(LocalMap, ANormalThatCameWithAPointCountsMoreThanItsCube) {
  LocalMap map({1, 100});
  Points floor;
  for (double x = 0.05; x < 1; x += 0.24)
    for (const double y : {0.05, 0.5, 0.95}) floor.emplace_back(x, y, 0.5);
  map.Add(floor, {{0, 0.6, 0.8}});
  const auto first = map.FindNearest(floor[0], 0.1);
  ASSERT_TRUE(first && first->has_normal);
  EXPECT_NEAR(first->normal.y(), 0.6, 1e-6);
  const auto second = map.FindNearest(floor[1], 0.1);
  ASSERT_TRUE(second && second->has_normal);
  EXPECT_NEAR(std::abs(second->normal.z()), 1, 1e-6);
}

TEST(LocalMap, ASurfaceTakesEightPoints) {
  const Points eight = {{0.1, 0.1, 0.5}, {0.5, 0.1, 0.5}, {0.9, 0.1, 0.5}, {0.1, 0.5, 0.5},
                        {0.9, 0.5, 0.5}, {0.1, 0.9, 0.5}, {0.5, 0.9, 0.5}, {0.9, 0.9, 0.5}};
  LocalMap map({1, 100});
  map.Add({eight.begin(), eight.end() - 1});
  EXPECT_FALSE(map.FindNearest({0.5, 0.5, 0.5}, 1)->has_normal);
  map.Add({eight.back()});
  const auto found = map.FindNearest({0.5, 0.5, 0.6}, 1);
  ASSERT_TRUE(found && found->has_normal);
  EXPECT_NEAR(std::abs(found->normal.z()), 1, 1e-6);
}

TEST(LocalMap, ASurfaceIsSeenWithTheCubesNextToIt) {
  // One cube has four points, and the next cube has eight. All points have the same height.
  LocalMap map({1, 100});
  map.Add({{0.1, 0.1, 0.5}, {0.6, 0.1, 0.5}, {0.1, 0.9, 0.5}, {0.6, 0.9, 0.5}});
  Points next;
  for (const double x : {1.1, 1.4, 1.7, 1.95})
    for (const double y : {0.2, 0.7}) next.emplace_back(x, y, 0.5);
  map.Add(next);
  const auto found = map.FindNearest({0.1, 0.1, 0.5}, 0.2);
  ASSERT_TRUE(found && found->has_normal);
  EXPECT_NEAR(std::abs(found->normal.z()), 1, 1e-6);
}

TEST(LocalMap, TheCubeBesideStandsWhereItIs) {
  // The points lie on the plane z = 0.3 x + 0.2. The cube of the searched point alone has too few
  // points for a surface.
  const auto on_plane = [](double x, double y) { return Eigen::Vector3d(x, y, 0.3 * x + 0.2); };
  for (const double beside : {-1., 1.}) {
    LocalMap map({1, 100});
    Points points;
    for (const double x : {0.1, 0.6})
      for (const double y : {0.1, 0.9}) points.push_back(on_plane(x, y));
    for (const double x : {0.05, 0.35, 0.65, 0.95})
      for (const double y : {0.2, 0.7}) points.push_back(on_plane(x + beside, y));
    for (Eigen::Vector3d& point : points) point.z() += 0.1;
    map.Add(points);
    const auto found = map.FindNearest(on_plane(0.1, 0.1) + Eigen::Vector3d(0, 0, 0.1), 0.2);
    ASSERT_TRUE(found && found->has_normal);
    const Eigen::Vector3d expected = Eigen::Vector3d(-0.3, 0, 1).normalized();
    EXPECT_NEAR(std::abs(found->normal.dot(expected)), 1, 1e-4);
  }
}

TEST(LocalMap, ACubeHoldsTwentyPoints) {
  LocalMap map({1, 100});
  Points grid;
  for (double x = 0.02; x < 1; x += 0.23)
    for (double y = 0.02; y < 1; y += 0.23) grid.emplace_back(x, y, 0.5);
  ASSERT_EQ(grid.size(), 25U);
  map.Add(grid);
  EXPECT_EQ(map.CountPoints(), 20U);
}

TEST(LocalMap, PointsAreAQuarterOfACubeApart) {
  LocalMap map({4.4721359, 100});  // With this size, points are at least 1 m apart.
  map.Add({{0.1, 0.1, 0.1}, {1.09, 0.1, 0.1}, {0.1, 1.11, 0.1}});
  EXPECT_EQ(map.CountPoints(), 2U);
}

TEST(LocalMap, SearchesAllCubesAroundAPoint) {
  for (const double x : {-0.05, 0.5, 1.05})
    for (const double y : {-0.05, 0.5, 1.05})
      for (const double z : {-0.05, 0.5, 1.05}) {
        LocalMap map({1, 100});
        map.Add({{x, y, z}});
        const Eigen::Vector3d asked(x < 0   ? 0.02
                                    : x > 1 ? 0.98
                                            : 0.5,
                                    y < 0   ? 0.02
                                    : y > 1 ? 0.98
                                            : 0.5,
                                    z < 0   ? 0.02
                                    : z > 1 ? 0.98
                                            : 0.5);
        const auto found = map.FindNearest(asked, 0.2);
        ASSERT_TRUE(found);
        EXPECT_LT((found->point - Eigen::Vector3d(x, y, z)).norm(), 1e-6);
      }
}

TEST(LocalMap, ForgetsWhatIsFartherThanItsRadiusOnly) {
  LocalMap map({1, 20});
  map.Add({{19.5, 0.5, 0.5}, {-20.5, 0.5, 0.5}, {0.5, 20.5, 0.5}});
  map.Forget({0, 0, 0});
  EXPECT_EQ(map.voxels(), 2U);  // the cubes with their corners at 19 and 20
  EXPECT_FALSE(map.FindNearest({-20.5, 0.5, 0.5}, 0.5));
}

TEST(LocalMap, KnowsThatACornerIsNoSurface) {
  LocalMap map({1, 100});
  map.Add(RandomPoints(200, 0.9));
  const auto found = map.FindNearest({0.5, 0.5, 0.5}, 1);
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->has_normal);
}

}  // namespace
}  // namespace lidar::odometry
