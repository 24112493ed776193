// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/odometry/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "src/odometry/trajectory_error.h"

namespace lidar::odometry {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

Pose At(double x, double y, double yaw) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ())), {x, y, 0}};
}

/// 299 m of a circle of radius 159 m, at 10 m/s.
Trajectory Circle(double scale = 1) {
  constexpr double kRadius = 159;
  Trajectory circle;
  for (int i = 0; i < 300; ++i) {
    const double turn = i / kRadius;
    circle.push_back(
        {Time{} + i * milliseconds(100),
         At(scale * kRadius * std::sin(turn), scale * kRadius * (1 - std::cos(turn)), turn)});
  }
  return circle;
}

Trajectory Read(const std::string& text, std::string* error) {
  std::istringstream in(text);
  return ReadTrajectory(in, milliseconds(100), error);
}

TEST(TumFiles, KeepNanosecondsOfUnixTime) {
  const StampedPose written{Time{} + seconds(1'700'000'000) + std::chrono::nanoseconds(123'456'789),
                            At(1.5, -2.25, 0.5)};
  std::ostringstream out;
  WriteTumLine(out, written);
  std::string error;
  const Trajectory read = Read(out.str(), &error);
  ASSERT_EQ(read.size(), 1U) << error;
  EXPECT_EQ(read[0].time, written.time);
  EXPECT_LT((read[0].pose.position - written.pose.position).norm(), 1e-6);
  EXPECT_LT(Angle(read[0].pose.Inverse() * written.pose), 1e-6);
}

TEST(KittiFiles, GetTheirTimesFromThePeriod) {
  std::ostringstream out;
  WriteKittiLine(out, At(1, 2, 0.5));
  WriteKittiLine(out, At(2, 2, 0.6));
  std::string error;
  const Trajectory read = Read(out.str(), &error);
  ASSERT_EQ(read.size(), 2U) << error;
  EXPECT_EQ(read[1].time - read[0].time, milliseconds(100));
  EXPECT_LT((read[1].pose.position - Eigen::Vector3d(2, 2, 0)).norm(), 1e-6);
}

TEST(TrajectoryFiles, AreReadWithoutALineThatWasCut) {
  std::string error;
  EXPECT_EQ(Read("# time x y z\n1.0 0 0 0 0 0 0 1\n2.0 0 0 0 0 0 0 1\n3.0 0 0 0 0", &error).size(),
            2U);
  EXPECT_EQ(Read("1.0 0 0 0 0 0 0 1\n2.0 0 0 0 0 0 0 1", &error).size(), 2U);
}

class BadTrajectoryFiles : public testing::TestWithParam<const char*> {};

TEST_P(BadTrajectoryFiles, AreRefusedWithAReason) {
  std::string error;
  EXPECT_TRUE(Read(GetParam(), &error).empty());
  EXPECT_FALSE(error.empty());
}

INSTANTIATE_TEST_SUITE_P(
    Trajectory, BadTrajectoryFiles,
    testing::Values("", "# nothing\n", "hello world\n", "1 2 3\n", "1.0 0 0 0 0 0 0 0\n",
                    "1.0 nan 0 0 0 0 0 1\n", "2.0 0 0 0 0 0 0 1\n1.0 0 0 0 0 0 0 1\n",
                    "1e300 0 0 0 0 0 0 1\n", "1 0 0 0 0 0 0 1\n1 2 3 4 5 6 7 8 9 10 11 12\n",
                    "1 2 3 4 5 6 7 8 9 10 11 12 13\n", "9 9 9 0 9 9 9 0 9 9 9 0\n"));

TEST(TrajectoryErrors, AreZeroForTheTruthInAnotherFrame) {
  const Trajectory truth = Circle();
  Trajectory moved = truth;
  for (StampedPose& p : moved) p.pose = At(5, -7, 2) * p.pose;
  const auto error = Compare(truth, moved);
  ASSERT_TRUE(error);
  EXPECT_LT(error->ate_rmse_m, 1e-6);
  EXPECT_LT(error->rpe_rmse_m, 1e-6);
  EXPECT_LT(error->end_error_m, 1e-6);
}

TEST(TrajectoryErrors, MeasureTheDriftOfAWrongScale) {
  const auto error = Compare(Circle(), Circle(1.02));
  ASSERT_TRUE(error);
  ASSERT_TRUE(error->drift);
  EXPECT_NEAR(*error->drift, 0.02, 0.001);
  EXPECT_NEAR(error->rpe_rmse_m, 0.02 * 10, 0.01);
}

TEST(TrajectoryErrors, InterpolateTheTruth) {
  const Trajectory truth = Circle();
  Trajectory between;
  for (std::size_t i = 1; i < truth.size(); ++i)
    between.push_back(
        {truth[i].time - milliseconds(30), InterpolateAt(truth, truth[i].time - milliseconds(30))});
  const auto error = Compare(truth, between);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->poses, between.size());
  EXPECT_LT(error->ate_rmse_m, 1e-6);
}

TEST(TrajectoryErrors, NeedThreePosesInCommon) {
  Trajectory later = Circle();
  for (StampedPose& p : later) p.time += seconds(100);
  EXPECT_FALSE(Compare(Circle(), later));
  EXPECT_FALSE(Compare({}, Circle()));
}

}  // namespace
}  // namespace lidar::odometry
