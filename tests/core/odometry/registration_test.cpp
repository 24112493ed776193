// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/odometry/registration.h"

#include <gtest/gtest.h>

#include <cmath>

#include "src/odometry/motion_threshold.h"

namespace lidar::odometry {
namespace {

constexpr double kReach_m = 1;
constexpr double kKernel_m = 0.3;

/// Returns points of a floor and of two walls that meet in a corner. Each surface is 8 m long. The
/// origin is inside the corner.
Points Corner() {
  Points points;
  for (double a = 0.05; a < 8; a += 0.25)
    for (double b = 0.05; b < 8; b += 0.25) {
      points.emplace_back(a - 4, b - 4, -1.5);
      points.emplace_back(a - 4, 4.5, b - 1.4);
      points.emplace_back(4.5, a - 4, b - 1.4);
    }
  return points;
}

Points Floor() {
  Points points;
  for (double a = 0.05; a < 8; a += 0.25)
    for (double b = 0.05; b < 8; b += 0.25) points.emplace_back(a - 4, b - 4, -1.5);
  return points;
}

LocalMap MapOf(const Points& points) {
  LocalMap map({1, 100});
  map.Add(points);
  return map;
}

/// Returns `points` in the axes of a sensor at `pose`.
Points SeenFrom(const Pose& pose, const Points& points) {
  Points seen;
  for (const Eigen::Vector3d& point : points) seen.push_back(pose.Inverse() * point);
  return seen;
}

Pose Moved(double x, double y, double z, double turn_z = 0) {
  Twist twist;
  twist << x, y, z, 0, 0, turn_z;
  return Exp(twist);
}

TEST(Align, FindsEveryDirectionOfAMotion) {
  LocalMap map = MapOf(Corner());
  for (const Pose& truth : {Moved(0.2, 0, 0), Moved(0, -0.2, 0), Moved(0, 0, 0.15),
                            Moved(0, 0, 0, 0.02), Moved(0.1, 0.1, -0.1, -0.02)}) {
    const Alignment found = Align(SeenFrom(truth, Corner()), &map, Pose(), kReach_m, kKernel_m, {});
    const Pose off = truth.Inverse() * found.pose;
    EXPECT_LT(off.position.norm(), 0.01);
    EXPECT_LT(Angle(off), 0.002);
    EXPECT_GT(found.inlier_share, 0.95);
    EXPECT_FALSE(found.degenerate);
    EXPECT_LT(found.iterations, 50);
  }
}

TEST(Align, KeepsTheGuessWhereTheSceneDoesNotShowTheMotion) {
  LocalMap map = MapOf(Floor());
  const Pose guess = Moved(0.3, -0.2, 0.1);
  const Alignment found =
      Align(SeenFrom(Moved(0, 0, 0), Floor()), &map, guess, kReach_m, kKernel_m, {});
  EXPECT_TRUE(found.degenerate);
  EXPECT_NEAR(found.pose.position.x(), 0.3, 0.01);
  EXPECT_NEAR(found.pose.position.y(), -0.2, 0.01);
  EXPECT_NEAR(found.pose.position.z(), 0, 0.01);
}

TEST(Align, APredictionDoesNotPullWhereSurfacesHoldEveryDirection) {
  LocalMap map = MapOf(Corner());
  const Prediction sure{Moved(0.2, 0, 0), Matrix6::Identity() * 1e4};
  const Alignment found = Align({Corner(), {}}, &map, sure, kReach_m, kKernel_m, {});
  EXPECT_LT(found.pose.position.norm(), 0.001);
}

/// A floor and a wall along x, and poles that alone show the motion along x.
TEST(Align, APredictionPullsWhereSurfacesLeaveADirectionOpen) {
  Points scene = Floor();
  for (double a = 0.05; a < 8; a += 0.25)
    for (double b = 0.05; b < 8; b += 0.25) scene.emplace_back(a - 4, 4.5, b - 1.4);
  for (const double x : {-3., -1., 1., 3.})
    for (const double y : {-3., -1., 1., 3.})
      for (const double z : {1., 3.}) scene.emplace_back(x, y, z);
  LocalMap map = MapOf(scene);
  RegistrationSettings settings;
  settings.least_constraint = 0.002;
  settings.least_balance = 0.005;
  const auto find = [&](double information) {
    Prediction prediction{Moved(0.2, 0, 0)};
    prediction.information(0, 0) = information;
    const auto found = Align({scene, {}}, &map, prediction, kReach_m, kKernel_m, settings);
    EXPECT_FALSE(found.degenerate);
    EXPECT_NEAR(found.pose.position.y(), 0, 0.005);
    return found.pose.position.x();
  };
  EXPECT_NEAR(find(0), 0, 0.005);
  EXPECT_NEAR(find(1e7), 0.2, 0.005);
}

TEST(Align, InATunnelOnlyTheMotionAlongItIsUnknown) {
  Points tunnel;
  for (double a = 0.05; a < 16; a += 0.25)
    for (double b = 0.05; b < 5; b += 0.25) {
      tunnel.emplace_back(a - 8, b - 2.5, -1.5);
      tunnel.emplace_back(a - 8, -2.6, b - 1.4);
      tunnel.emplace_back(a - 8, 2.6, b - 1.4);
    }
  LocalMap map = MapOf(tunnel);
  const Alignment found = Align(tunnel, &map, Moved(0.3, -0.1, 0.1), kReach_m, kKernel_m, {});
  EXPECT_TRUE(found.degenerate);
  EXPECT_NEAR(found.pose.position.x(), 0.3, 0.01);
  EXPECT_NEAR(found.pose.position.y(), 0, 0.01);
  EXPECT_NEAR(found.pose.position.z(), 0, 0.01);
}

TEST(Align, TheNormalOfACircleLetsItMoveAlong) {
  // The circle that a beam draws on the floor moves with the sensor, so each scan shows the same
  // circle.
  Points circle;
  for (int i = 0; i < 200; ++i)
    circle.emplace_back(3 * std::cos(0.03 * i), 3 * std::sin(0.03 * i), -1.5);
  Points corner = Corner();
  LocalMap map({1, 100});
  Points all = circle;
  all.insert(all.end(), corner.begin(), corner.end());
  map.Add(all, Points(circle.size(), {0, 0, 1}));
  const Pose truth = Moved(0.3, 0.2, 0);
  Points seen = SeenFrom(truth, corner);
  seen.insert(seen.end(), circle.begin(), circle.end());
  const Alignment found = Align(seen, &map, Pose(), kReach_m, kKernel_m, {});
  EXPECT_LT((truth.Inverse() * found.pose).position.norm(), 0.01);
}

TEST(Align, NeighboursWithoutASurfaceCountLittleWhereSurfacesHoldAllDirections) {
  // The sensor sees a room without a change. Some single points in the room have moved.
  Points scattered;
  for (const double x : {-3., -1., 1., 3.})
    for (const double y : {-3., -1., 1., 3.})
      for (const double z : {1., 3.}) scattered.emplace_back(x, y, z);
  Points all = Corner();
  all.insert(all.end(), scattered.begin(), scattered.end());
  LocalMap map = MapOf(all);
  Points seen = Corner();
  for (const Eigen::Vector3d& p : scattered) seen.push_back(p + Eigen::Vector3d(0, 0, 0.3));
  const auto height = [&](double weight, double held) {
    RegistrationSettings settings;
    settings.spare_point_weight = weight;
    settings.held_by_surfaces = held;
    return std::abs(Align(seen, &map, Pose(), kReach_m, 1, settings).pose.position.z());
  };
  EXPECT_GT(height(1, 0.04), 10 * height(0.01, 0.04));
  EXPECT_EQ(height(0.01, 0.9), height(1, 0.04));
}

TEST(Align, TellsThePartOfThePointsThatFit) {
  LocalMap map = MapOf(Corner());
  Points seen = Corner();
  const std::size_t whole = seen.size();
  for (std::size_t i = 0; i < whole; ++i) seen.emplace_back(100, 100, 100);
  const Alignment found = Align(seen, &map, Pose(), kReach_m, kKernel_m, {});
  EXPECT_DOUBLE_EQ(found.inlier_share, 0.5);
  EXPECT_LT(found.pose.position.norm(), 1e-3);
}

TEST(Align, GroundThatTheScanShowsDoesNotStandWhateverTheMapHasThere) {
  // The map has only a few points of the floor, and no points of the poles.
  const Points floor = Floor();
  Points sparse;
  for (std::size_t i = 0; i < floor.size(); i += 50) sparse.push_back(floor[i]);
  LocalMap map = MapOf(sparse);
  Surface seen{floor, Points(floor.size(), Eigen::Vector3d::UnitZ())};
  for (int i = 0; i < 50; ++i) seen.points.emplace_back(i % 10, i / 10, floor[0].z() + 5);
  const auto found = Align(seen, &map, Prediction{}, kReach_m, kKernel_m, {});
  EXPECT_GT(found.inlier_share, 0);
  EXPECT_LT(found.standing_share, 1e-9);
}

/// The world has poles and twigs over a floor. Each of them is a single point.
TEST(Align, CountsPointsWithoutASurfaceAmongThoseThatStand) {
  Points twigs;
  for (double x = -3; x < 4; x += 2)
    for (double y = -3; y < 4; y += 2)
      for (double z = 2.5; z < 12; z += 2) twigs.emplace_back(x, y, z);
  ASSERT_GT(twigs.size(), 60U);
  Points world = Floor();
  world.insert(world.end(), twigs.begin(), twigs.end());
  LocalMap map = MapOf(world);
  for (const std::size_t moved : {std::size_t{0}, twigs.size() / 4, twigs.size()}) {
    Points seen = Floor();
    for (std::size_t i = 0; i < twigs.size(); ++i)
      seen.push_back(twigs[i] + Eigen::Vector3d(0, 0, i < moved ? 0.7 : 0));
    RegistrationSettings settings;
    settings.max_iterations = 1;
    const Alignment found = Align(seen, &map, Pose(), kReach_m, kKernel_m, settings);
    const double standing = 1 - static_cast<double>(moved) / static_cast<double>(twigs.size());
    EXPECT_NEAR(found.standing_share, standing, 0.05) << moved;
  }
}

TEST(Align, LeavesTheGuessWhereFewerThanTwentyPointsFit) {
  LocalMap map = MapOf(Corner());
  const Pose guess = Moved(0.05, 0, 0);
  for (const std::size_t count : {19U, 20U}) {
    const Points all = Corner();
    Points few;
    for (std::size_t i = 0; i < count; ++i) few.push_back(all[i * 97 % all.size()]);
    for (int i = 0; i < 50; ++i) few.emplace_back(100, 100, 100);
    const Alignment found = Align(few, &map, guess, kReach_m, kKernel_m, {});
    EXPECT_NEAR(found.inlier_share, static_cast<double>(count) / static_cast<double>(few.size()),
                1e-9);
    EXPECT_EQ((found.pose.position - guess.position).norm() == 0, count == 19);
  }
}

TEST(Align, StaysWithTheGuessWithoutPointsOrMap) {
  LocalMap map = MapOf(Corner());
  LocalMap empty({1, 100});
  const Pose guess = Moved(1, 2, 3);
  EXPECT_EQ(Align({}, &map, guess, kReach_m, kKernel_m, {}).pose.position, guess.position);
  EXPECT_EQ(Align(Corner(), &empty, guess, kReach_m, kKernel_m, {}).inlier_share, 0);
}

TEST(Align, EndsAfterItsMostIterations) {
  LocalMap map = MapOf(Corner());
  RegistrationSettings settings;
  settings.max_iterations = 3;
  settings.converged = 0;
  const Alignment found =
      Align(SeenFrom(Moved(0.2, 0, 0), Corner()), &map, Pose(), kReach_m, kKernel_m, settings);
  EXPECT_GE(found.iterations, 3);
  EXPECT_LE(found.iterations, 4);
}

TEST(MotionThreshold, IsTheRootOfTheMeanSquare) {
  MotionThreshold threshold(100);
  EXPECT_EQ(threshold.sigma_m(), 2);
  threshold.Add(Moved(0.09, 0, 0));  // A sensor at rest has deviations of this size.
  EXPECT_EQ(threshold.sigma_m(), 2);
  threshold.Add(Moved(3, 0, 0));
  EXPECT_NEAR(threshold.sigma_m(), 3, 1e-9);
  threshold.Add(Moved(0, -4, 0));
  EXPECT_NEAR(threshold.sigma_m(), std::sqrt((9. + 16) / 2), 1e-9);
}

TEST(MotionThreshold, CountsHowFarATurnMovesTheFarthestPoints) {
  MotionThreshold threshold(100);
  threshold.Add(Moved(0, 0, 0, 0.02));
  EXPECT_NEAR(threshold.sigma_m(), 2 * 100 * std::sin(0.01), 1e-9);
}

}  // namespace
}  // namespace lidar::odometry
