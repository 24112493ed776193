// SPDX-License-Identifier: LGPL-2.1-or-later
// A drive around a block whose odometry drifts.
#include "src/slam/loop_closer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "src/slam/pose_graph.h"

namespace lidar::slam {
namespace {

using odometry::Points;
using odometry::Pose;

constexpr double kTurn = 6.283185307179586;
constexpr double kRadius = 60;  // of the round trip [m]
constexpr int kScansOfALap = 190;

Pose TrueAt(int scan) {
  const double angle = kTurn * scan / kScansOfALap;
  Pose pose;
  pose.position = {kRadius * std::sin(angle), kRadius * (1 - std::cos(angle)), 0};
  pose.rotation = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ());
  return pose;
}

/// Ground, and pillars of many sizes that stand anywhere.
Points MakeWorld() {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> anywhere(-130, 130);
  std::uniform_real_distribution<double> size(0.5, 4);
  Points world;
  for (double x = -110; x < 110; x += 2.5)
    for (double y = -50; y < 170; y += 2.5) world.emplace_back(x, y, -1.9);
  for (int i = 0; i < 150; ++i) {
    const Eigen::Vector3d corner(anywhere(random), kRadius + anywhere(random), -1.9);
    const double wide = size(random);
    const double high = 2 * size(random);
    for (double along = 0; along < wide; along += 0.5)
      for (double z = 0; z < high; z += 0.5) {
        world.push_back(corner + Eigen::Vector3d(along, 0, z));
        world.push_back(corner + Eigen::Vector3d(0, along, z));
      }
  }
  return world;
}

Points SeenFrom(const Pose& pose, const Points& world, int scan) {
  const Pose back = pose.Inverse();
  Points points;
  // Together the scans of a local map see every point.
  for (std::size_t i = static_cast<std::size_t>(scan % 16); i < world.size(); i += 16)
    if ((world[i] - pose.position).squaredNorm() < 3600) points.push_back(back * world[i]);
  return points;
}

/// What an odometry makes of the lap: each step is a little too long and turns a little too far.
odometry::Trajectory Drive(int scans) {
  odometry::Trajectory way;
  for (int i = 0; i < scans; ++i) {
    odometry::StampedPose stamped;
    stamped.time = Time{} + std::chrono::milliseconds(100) * i;
    if (i > 0) {
      Pose step = TrueAt(i - 1).Inverse() * TrueAt(i);
      step.position *= 1.01;
      step.position.z() += 0.01;
      step.rotation = step.rotation * Eigen::AngleAxisd(0.0004, Eigen::Vector3d::UnitZ());
      stamped.pose = way.back().pose * step;
    }
    way.push_back(stamped);
  }
  return way;
}

double EndError(const odometry::Trajectory& way) {
  return (way.back().pose.position - TrueAt(static_cast<int>(way.size()) - 1).position).norm();
}

TEST(LoopCloser, TakesTheDriftOutOfADriveThatReturns) {
  const Points world = MakeWorld();
  const odometry::Trajectory drifted = Drive(kScansOfALap + 12);
  LoopCloser closer({});
  for (std::size_t i = 0; i < drifted.size(); ++i) {
    const int scan = static_cast<int>(i);
    closer.AddScan(drifted[i], SeenFrom(TrueAt(scan), world, scan));
  }
  const odometry::Trajectory closed = closer.Close();
  ASSERT_EQ(closed.size(), drifted.size());
  EXPECT_GE(closer.closures().size(), 1U);
  EXPECT_GT(EndError(drifted), 3);
  EXPECT_LT(EndError(closed), EndError(drifted) / 5);
  EXPECT_LT(closed.front().pose.position.norm(), 1e-9);
}

TEST(LoopCloser, LeavesADriveAloneThatDoesNotReturn) {
  const Points world = MakeWorld();
  const odometry::Trajectory drifted = Drive(kScansOfALap / 2);
  LoopCloser closer({});
  for (std::size_t i = 0; i < drifted.size(); ++i) {
    const int scan = static_cast<int>(i);
    closer.AddScan(drifted[i], SeenFrom(TrueAt(scan), world, scan));
  }
  const odometry::Trajectory closed = closer.Close();
  EXPECT_TRUE(closer.closures().empty());
  EXPECT_EQ(closed.back().pose.position, drifted.back().pose.position);
}

TEST(LoopCloser, TakesADriveWithoutPoints) {
  LoopCloser closer({});
  EXPECT_TRUE(closer.Close().empty());
  LoopCloser blind({});
  for (const odometry::StampedPose& pose : Drive(kScansOfALap + 12)) blind.AddScan(pose, {});
  EXPECT_EQ(blind.Close().size(), std::size_t{kScansOfALap + 12});
  EXPECT_TRUE(blind.closures().empty());
}

TEST(LoopCloser, DoubtsTheClosureThatIsMostContradicted) {
  const std::vector<Pose> poses(4);  // all at one place
  std::vector<Closure> closures(3);
  closures[0].pose.position.x() = 2;
  closures[1].pose.position.x() = 9;
  closures[2].pose.rotation = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(FindWorst(closures, poses), 1U);
  closures.erase(closures.begin() + 1);
  EXPECT_EQ(FindWorst(closures, poses), 1U);  // twice as far as it may turn
  closures.pop_back();
  closures[0].pose.position.x() = 1.4;
  EXPECT_EQ(FindWorst(closures, poses), 1U);  // none
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

TEST(PoseGraph, SpreadsWhatALoopContradicts) {
  // A square whose fourth side ends a metre beside its beginning.
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
