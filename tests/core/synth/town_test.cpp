// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "src/synth/scanner.h"
#include "src/synth/terrain.h"
#include "src/synth/town_route.h"

namespace lidar::synth {
namespace {

TEST(Terrain, PlansAndPlacesAreTheSamePoints) {
  for (const double x : {-900.0, -31.0, 0.0, 250.0, 1234.5}) {
    for (const double y : {-700.0, 12.0, 480.0}) {
      const Terrain::Point back = Terrain::FromPlan(Terrain::ToPlan({x, y}));
      EXPECT_NEAR(back.a, x, 1e-3);
      EXPECT_NEAR(back.b, y, 1e-3);
    }
  }
}

TEST(Terrain, IsTheSameAroundAnyAnchor) {
  for (const double anchor : {-720.0, 0.0, 3600.0}) {
    const Terrain::Local local(anchor, -anchor);
    for (const float at : {-130.0F, 0.0F, 77.0F}) {
      const double x = anchor + static_cast<double>(at);
      const double y = -anchor - static_cast<double>(at);
      const Terrain::Ground ground = Terrain::At({x, y});
      EXPECT_NEAR(local.HeightAt(at, -at).z, ground.height, 1e-3);
      EXPECT_NEAR(local.HeightAt(at, -at).slope_x, ground.slope_x, 1e-4);
      EXPECT_NEAR(static_cast<double>(local.PlanU(at, -at)) + anchor, Terrain::ToPlan({x, y}).a,
                  1e-2);
    }
  }
}

TEST(TownRoute, ReturnsToWhereItBeganAndGoesOn) {
  const TownRoute route(12);
  EXPECT_NEAR(route.lap_m(), 2000, 150);
  for (const double t : {0.0, 17.3, 101.0}) {
    const Route::Place a = route.At(t);
    const Route::Place b = route.At(t + route.lap_s());
    EXPECT_NEAR(a.x, b.x, 1e-6);
    EXPECT_NEAR(a.yaw, b.yaw, 1e-6);
    EXPECT_NEAR(b.distance - a.distance, route.lap_m(), 1e-6);
  }
}

TEST(TownRoute, DrivesSmoothlyAndSlowsDownForCorners) {
  const TownRoute route(12);
  double slowest = 100;
  for (double t = 0; t < route.lap_s(); t += 0.1) {
    const Route::Place a = route.At(t);
    const Route::Place b = route.At(t + 0.1);
    const double speed = std::hypot(b.x - a.x, b.y - a.y) / 0.1;
    slowest = std::min(slowest, speed);
    ASSERT_LT(speed, 12.3) << t;
    ASSERT_LT(std::abs(std::remainder(b.yaw - a.yaw, 6.283185307179586)), 0.08) << t;
    ASSERT_NEAR(b.z - a.z, (a.grade + b.grade) / 2 * speed * 0.1, 0.01) << t;
  }
  EXPECT_NEAR(slowest, 4.7, 1);
}

TEST(TownRoute, StandsStillAtSpeedZero) {
  const TownRoute route(0);
  EXPECT_EQ(route.At(0).x, route.At(100).x);
  EXPECT_EQ(route.At(100).distance, 0);
}

TEST(Town, TheRoadIsUnderTheSensorEverywhereOnTheWay) {
  ScannerConfig config;
  config.sensor = *MakeSensor("os0-32", 512);
  config.scene = SceneKind::kTown;
  config.speed_mps = 12;
  config.noise_m = 0;
  Scanner scanner(config);
  const RangeProjection projection(config.sensor.model);
  Returns returns;
  for (std::uint64_t scan = 0; scan < 1800; scan += 60) {
    scanner.Cast(scan, {0, 2}, &returns);
    const Pose pose = scanner.trajectory().At(scanner.ColumnTime(scan, 0));
    const std::uint32_t lowest = 31;  // This beam looks down at 45 degrees.
    ASSERT_GT(returns.range_mm[lowest * 2], 0U) << scan;
    const auto p = projection.Point(lowest, 0, returns.range_mm[lowest * 2]);
    const Vec3 world = pose.ToRotation() * Vec3{p[0], p[1], p[2]};
    const double x = pose.x + static_cast<double>(world.x);
    const double y = pose.y + static_cast<double>(world.y);
    EXPECT_NEAR(pose.z + static_cast<double>(world.z), Terrain::At({x, y}).height, 0.16) << scan;
  }
}

TEST(Town, TheSensorStandsUprightOnItsRoadEverywhereOnTheWay) {
  TrajectorySettings lane = Scene::Make(SceneKind::kTown, 1)->Lane(12);
  lane.bounce = 0;
  for (const double sway_m : {0., 2.}) {
    lane.sway_m = sway_m;
    const Trajectory trajectory(lane);
    for (int second = 0; second < 180; second += 3) {
      const Pose pose = trajectory.At(std::chrono::seconds(second));
      const Terrain::Ground ground = Terrain::At({pose.x, pose.y});
      EXPECT_NEAR(pose.z - ground.height, lane.sensor_height_m, 0.01) << second;
      if (sway_m > 0) continue;  // the car then leaves the direction of the road
      for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}}) {
        const Vec3 world = pose.ToRotation() * axis;
        const double rise = ground.slope_x * static_cast<double>(world.x) +
                            ground.slope_y * static_cast<double>(world.y);
        EXPECT_NEAR(static_cast<double>(world.z), rise, 0.001) << second;
      }
    }
  }
}

TEST(Scanner, MixesPixelsAtEdgesOnly) {
  ScannerConfig config;
  config.sensor = *MakeSensor("os1-32", 512);
  config.speed_mps = 12;
  config.noise_m = 0;
  Returns plain;
  Scanner(config).Cast(3, {0, 512}, &plain);
  config.mixed_pixels = true;
  Returns mixed;
  Scanner(config).Cast(3, {0, 512}, &mixed);
  std::size_t between = 0;
  std::size_t changed = 0;
  for (std::size_t i = 1; i < plain.range_mm.size(); ++i) {
    const auto was = static_cast<int>(plain.range_mm[i]);
    const auto beside = static_cast<int>(plain.range_mm[i - 1]);
    const auto is = static_cast<int>(mixed.range_mm[i]);
    if (was == 0 || is == 0 || beside == 0 || was == is) continue;
    ++changed;
    between += is >= std::min(was, beside) - 2 && is <= std::max(was, beside) + 2;
  }
  EXPECT_GT(changed, 50U);
  EXPECT_LT(changed, plain.range_mm.size() / 20);
  EXPECT_GT(between, changed * 9 / 10);
}

}  // namespace
}  // namespace lidar::synth
