// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/slam/loop_closer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "src/slam/pose_graph.h"
#include "tests/support/block_drive.h"

namespace lidar::slam {
namespace {

using odometry::Points;
using odometry::Pose;
using namespace test::block;

void AddDrive(const odometry::Trajectory& drifted, LoopCloser* closer) {
  const Points world = MakeWorld();
  for (std::size_t i = 0; i < drifted.size(); ++i) {
    const int scan = static_cast<int>(i);
    closer->AddScan(drifted[i], SeenFrom(TrueAt(scan), world, scan));
  }
  closer->Finish();
}

TEST(LoopCloser, TakesTheDriftOutOfADriveThatReturns) {
  const odometry::Trajectory drifted = Drive(kScansOfALap + 12);
  LoopCloser closer({});
  AddDrive(drifted, &closer);
  const odometry::Trajectory closed = closer.Correct(drifted);
  ASSERT_EQ(closed.size(), drifted.size());
  EXPECT_GE(closer.closures().size(), 1U);
  EXPECT_GT(EndError(drifted), 3);
  EXPECT_LT(EndError(closed), EndError(drifted) / 5);
  EXPECT_LT(closed.front().pose.position.norm(), 1e-9);
}

TEST(LoopCloser, LeavesADriveAloneThatDoesNotReturn) {
  const odometry::Trajectory drifted = Drive(kScansOfALap / 2);
  LoopCloser closer({});
  AddDrive(drifted, &closer);
  const odometry::Trajectory closed = closer.Correct(drifted);
  EXPECT_TRUE(closer.closures().empty());
  EXPECT_TRUE(closed.back().pose.position.isApprox(drifted.back().pose.position));
}

TEST(LoopCloser, TakesADriveWithoutPoints) {
  LoopCloser closer({});
  closer.Finish();
  EXPECT_TRUE(closer.Correct({}).empty());
  LoopCloser blind({});
  const odometry::Trajectory way = Drive(kScansOfALap + 12);
  for (const odometry::StampedPose& pose : way) blind.AddScan(pose, {});
  blind.Finish();
  EXPECT_TRUE(blind.Correct(way).back().pose.position.isApprox(way.back().pose.position));
  EXPECT_TRUE(blind.closures().empty());
}

TEST(LoopCloser, SearchesFartherAfterALongerWay) {
  LoopSettings settings;
  // The search distance then comes from drift_share only.
  settings.drift_m = -settings.local_map_m;
  settings.drift_share = 0.1;
  LoopCloser closer(settings);
  AddDrive(Drive(kScansOfALap + 12), &closer);
  EXPECT_FALSE(closer.closures().empty());
}

TEST(LoopCloser, MovesTheMapAndNotTheOdometry) {
  const odometry::Trajectory drifted = Drive(kScansOfALap + 30);
  LoopCloser closer({});
  AddDrive(drifted, &closer);
  odometry::Trajectory now = drifted;
  now.back().pose = closer.MapFromOdometry() * drifted.back().pose;
  EXPECT_LT(EndError(now), EndError(drifted) / 5);
}

/// The drive has three laps around the block. There is room for hardly more maps than those of one
/// lap.
TEST(LoopCloser, BoundsItsMapsByForgettingThoseThatLieOverOthers) {
  const Points world = MakeWorld();
  const odometry::Trajectory drifted = Drive(3 * kScansOfALap);
  LoopSettings settings;
  settings.most_maps = 11;  // A lap needs 9 maps.
  LoopCloser closer(settings);
  for (std::size_t i = 0; i < drifted.size(); ++i) {
    const int scan = static_cast<int>(i);
    closer.AddScan(drifted[i], SeenFrom(TrueAt(scan), world, scan));
    ASSERT_LE(closer.local_maps(), settings.most_maps);
  }
  closer.Finish();
  EXPECT_LT(EndError(closer.Correct(drifted)), EndError(drifted) / 5);
}

/// The drive begins with one map before the block, makes a lap of ten maps, and repeats the first
/// map of the lap. The closer forgets the first map of the lap, because the last map is at the same
/// place.
TEST(LoopCloser, MovesTheClosureOfAForgottenMapToTheOneBefore) {
  constexpr int kScansOfAMap = kScansOfALap / 10;
  const Points world = MakeWorld();
  const double step_m = TrueAt(1).position.norm();
  LoopSettings settings;
  settings.local_map_m = (kScansOfAMap - 1.2) * step_m;
  settings.drift_m = -0.5 * settings.local_map_m;  // Adjacent maps make no loop.
  settings.drift_share = 0;
  settings.most_maps = 11;
  LoopCloser closer(settings);
  for (int scan = 0; scan < 2 * kScansOfAMap + kScansOfALap; ++scan) {
    const int on_lap = scan - kScansOfAMap;
    odometry::StampedPose stamped{Time{} + std::chrono::milliseconds(100) * scan, TrueAt(on_lap)};
    if (on_lap < 0) {
      stamped.pose.position = {0, on_lap * step_m, 0};
      stamped.pose.rotation = Eigen::AngleAxisd(kTurn / 4, Eigen::Vector3d::UnitZ());
    }
    closer.AddScan(stamped, SeenFrom(stamped.pose, world, scan));
  }
  EXPECT_EQ(closer.local_maps(), settings.most_maps);
  ASSERT_EQ(closer.closures().size(), 1U);
  const Closure& closure = closer.closures().front();
  EXPECT_EQ(closure.from, 0U);
  EXPECT_EQ(closure.to, settings.most_maps - 1);
  // The middle of one map is half a map before the corner. The middle of the other map is half a
  // map after it.
  EXPECT_NEAR(closure.pose.position.norm(), std::sqrt(0.5) * kScansOfAMap * step_m, 5);
}

/// Returns the mean distance of the poses from the true ones [m].
double MeanError(const odometry::Trajectory& way) {
  double sum = 0;
  for (std::size_t i = 0; i < way.size(); ++i)
    sum += (way[i].pose.position - TrueAt(static_cast<int>(i)).position).norm();
  return sum / static_cast<double>(way.size());
}

/// The drive has three laps around the block. There is room for so few maps that the closer also
/// forgets the maps of a closure.
TEST(LoopCloser, GoesOnSolvingWhereTheMapsOfAClosureAreForgotten) {
  const Points world = MakeWorld();
  const odometry::Trajectory drifted = Drive(3 * kScansOfALap);
  LoopSettings settings;
  settings.most_maps = 4;
  LoopCloser closer(settings);
  for (std::size_t i = 0; i < drifted.size(); ++i) {
    const int scan = static_cast<int>(i);
    closer.AddScan(drifted[i], SeenFrom(TrueAt(scan), world, scan));
    for (const Closure& c : closer.closures()) {
      ASSERT_LT(c.from, c.to) << i;
      ASSERT_LT(c.to, closer.local_maps()) << i;
    }
  }
  closer.Finish();
  EXPECT_GT(closer.solved(), 3U);
  EXPECT_LT(EndError(closer.Correct(drifted)), EndError(drifted) / 5);
  // A map that is left drifts by the scans of those before it that are forgotten, too.
  EXPECT_LT(MeanError(closer.Correct(drifted)), MeanError(drifted) / 5);
}

/// The possible drift is so large that all maps are candidates. The closer searches eight of them.
TEST(LoopCloser, SearchesTheNearestMaps) {
  const odometry::Trajectory drifted = Drive(2 * kScansOfALap);
  LoopSettings settings;
  settings.drift_m = 1'000;
  LoopCloser closer(settings);
  AddDrive(drifted, &closer);
  ASSERT_EQ(closer.local_maps(), 19U);  // A lap needs 9 maps.
  for (std::size_t map = 16; map < 19; ++map)
    EXPECT_TRUE(std::any_of(closer.closures().begin(), closer.closures().end(),
                            [map](const Closure& c) { return c.to == map && c.from == map - 9; }))
        << map << " lies on the map of a lap before";
}

/// A sensor at rest sees nothing new. Its noise must not count as motion.
TEST(LoopCloser, MakesNoMapsWhereTheSensorStands) {
  LoopCloser closer({});
  odometry::StampedPose pose;
  for (int i = 0; i < 10'000; ++i) {
    pose.time += std::chrono::milliseconds(100);
    pose.pose.position.x() = 0.1 * (i % 2);
    closer.AddScan(pose, {{1, 2, 3}});
  }
  EXPECT_EQ(closer.local_maps(), 0U);
}

TEST(LoopCloser, DoubtsTheClosureThatIsMostContradicted) {
  const std::vector<Pose> poses(4);  // All poses are at the same place.
  std::vector<Closure> closures(3);
  closures[0].pose.position.x() = 2;
  closures[1].pose.position.x() = 9;
  closures[2].pose.rotation = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(FindWorst(closures, poses), 1U);
  closures.erase(closures.begin() + 1);
  EXPECT_EQ(FindWorst(closures, poses), 1U);  // This closure turns twice as far as allowed.
  closures.pop_back();
  closures[0].pose.position.x() = 1.4;
  EXPECT_EQ(FindWorst(closures, poses), 1U);  // Now no closure turns.
}

TEST(Place, IsFoundAgainTurnedMovedAndTilted) {
  const Points world = MakeWorld();
  Points here;
  Points there;
  Pose moved;
  moved.position = {7, -4, 0.8};
  moved.rotation = Eigen::AngleAxisd(0.6, Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(0.04, Eigen::Vector3d::UnitY());
  for (const Eigen::Vector3d& p : world) {
    here.push_back(p);
    there.push_back(moved.Inverse() * p);
  }
  const auto match = Match(Place(here), Place(there), 0.5, 0.25);
  ASSERT_TRUE(match);
  EXPECT_GT(match->score, 0.5);
  EXPECT_GT(match->distinct, 2);
  const Pose off = moved.Inverse() * match->pose;
  EXPECT_LT(off.position.norm(), 1.5);
  EXPECT_LT(Angle(off), 0.05);
}

/// Columns, each with one point of ground.
Points Columns(int count) {
  Points columns;
  for (int i = 0; i < count; ++i)
    for (const double z : {0., 1., 2., 3.})
      columns.emplace_back(2 * (i % 6) + 1, 2 * (i / 6) + 1, z);
  return columns;
}

TEST(Place, IsFoundOnlyWithEnoughGroundInCommon) {
  EXPECT_TRUE(Match(Place(Columns(30)), Place(Columns(30)), 0, 0));
  EXPECT_TRUE(Match(Place(Columns(42)), Place(Columns(30)), 0, 0));
  EXPECT_FALSE(Match(Place(Columns(29)), Place(Columns(29)), 0, 0));
  EXPECT_FALSE(Match(Place(Columns(42)), Place(Columns(29)), 0, 0));
  EXPECT_FALSE(Match(Place({}), Place(Columns(42)), 0, 0));
}

TEST(PoseGraph, SpreadsWhatALoopContradicts) {
  // The poses are a square. The end of its fourth side is a metre away from the begin of the first
  // side.
  std::vector<Pose> poses(5);
  std::vector<Edge> edges;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    Pose step;
    step.position = {10, 0.25, 0};
    step.rotation = Eigen::AngleAxisd(kTurn / 4, Eigen::Vector3d::UnitZ());
    poses[i] = poses[i - 1] * step;
    edges.push_back({i - 1, i, step, 0.1, 0.01});
  }
  edges.push_back({0, 4, Pose{}, 0.001, 0.001});
  poses[4].position.x() += 1;
  ASSERT_TRUE(Optimise(edges, &poses));
  EXPECT_LT(poses[4].position.norm(), 0.01);
  EXPECT_EQ(poses[0].position.norm(), 0);
  for (std::size_t i = 1; i < 4; ++i)
    EXPECT_NEAR((poses[i].position - poses[i - 1].position).norm(), 10, 0.3);
}

TEST(PoseGraph, RefusesEdgesToNowhere) {
  std::vector<Pose> poses(2);
  EXPECT_FALSE(Optimise({{0, 7, Pose{}, 1, 1}}, &poses));
  EXPECT_FALSE(Optimise({}, &poses));
}

}  // namespace
}  // namespace lidar::slam
