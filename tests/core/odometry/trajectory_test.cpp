// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/odometry/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <locale>
#include <sstream>

#include "src/odometry/trajectory_error.h"
#include "tests/support/german_numbers.h"

namespace lidar::odometry {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

Pose At(double x, double y, double yaw) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ())), {x, y, 0}};
}

/// Returns 299 m of a circle with a radius of 159 m. The speed is 10 m/s. All lengths are
/// multiplied by `scale`.
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

TEST(TumFiles, HaveNineDigitsBehindThePoint) {
  std::ostringstream out;
  WriteTumLine(out, {Time{} + std::chrono::nanoseconds(42), At(0, 0, 0)});
  EXPECT_EQ(out.str().rfind("0.000000042 ", 0), 0U) << out.str();
}

TEST(TrajectoryFiles, AreTheSameInAnyLocale) {
  const StampedPose before_1970{Time{} - milliseconds(1'700'250), At(1234.5, -2.25, 0)};
  std::ostringstream german;
  german.imbue(std::locale(std::locale::classic(), new test::GermanNumbers));
  WriteTumLine(german, before_1970);
  EXPECT_EQ(german.str(),
            "-1700.250000000 1234.500000 -2.250000 0.000000 0.000000000 0.000000000 0.000000000 "
            "1.000000000\n");
  std::ostringstream kitti;
  kitti.imbue(std::locale(std::locale::classic(), new test::GermanNumbers));
  WriteKittiLine(kitti, before_1970.pose);
  EXPECT_EQ(kitti.str().substr(0, 64),
            "1.000000000e+00 0.000000000e+00 0.000000000e+00 1.234500000e+03 ");
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
  EXPECT_EQ(Read("1.0 0 0 0 0 0 0 1\n2.0 0 0 0 0 0 -", &error).size(), 1U) << error;
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
                    "1e300 0 0 0 0 0 0 1\n", "9000000001 0 0 0 0 0 0 1\n",
                    "-9000000001.5 0 0 0 0 0 0 1\n", "99999999999999999999 0 0 0 0 0 0 1\n",
                    "0 0 0 0 0 0 0 1\n1 0 0 0 0 1 0 0 0 0 1 0\n", "1 0 0 0 0 1 0 0 0 0 1 0 5\n",
                    "1 0 0 0 0 1 0 0 0 0 1 x\n", "1.0-2.0 0 0 0 0 0 1\n",
                    "1 2 3 4 5 6 7 8 9 10 11 12 13\n", "9 9 9 0 9 9 9 0 9 9 9 0\n"));

TEST(TrajectoryErrors, AreZeroForTheTruthInAnotherFrame) {
  const Trajectory truth = Circle();
  Trajectory moved = truth;
  for (StampedPose& p : moved) p.pose = At(5, -7, 2) * p.pose;
  // A quaternion and its negative are the same rotation.
  for (std::size_t i = 0; i < moved.size(); i += 2) moved[i].pose.rotation.coeffs() *= -1;
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

TEST(Trajectories, AreInterpolatedInProportionToTheTime) {
  Trajectory two(2);
  two[1].time = Time{} + milliseconds(100);
  two[1].pose.position = {8, -4, 0};
  two[1].pose.rotation = Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitZ());
  for (const int ms : {-50, 0, 25, 50, 75, 100, 150}) {
    const double part = std::clamp(ms / 100.0, 0.0, 1.0);
    const Pose pose = InterpolateAt(two, Time{} + milliseconds(ms));
    EXPECT_NEAR((pose.position - part * two[1].pose.position).norm(), 0, 1e-12) << ms;
    EXPECT_NEAR(Angle(pose), part * 0.8, 1e-9) << ms;
  }
}

TEST(TrajectoryErrors, NeedThreePosesInCommon) {
  Trajectory later = Circle();
  for (StampedPose& p : later) p.time += seconds(100);
  EXPECT_FALSE(Compare(Circle(), later));
  EXPECT_FALSE(Compare({}, Circle()));
}

TEST(TrajectoryFiles, MayHaveTimesBefore1970AndPosesOfOneTime) {
  std::string error;
  const auto read = Read("-1.25 0 0 0 0 0 0 1\n-1.25 1 0 0 0 0 0 1\n9e9 2 0 0 0 0 0 1\n", &error);
  ASSERT_EQ(read.size(), 3U) << error;
  EXPECT_EQ(read[0].time, Time{} - milliseconds(1'250));
  EXPECT_EQ(read[2].time, Time{} + seconds(9'000'000'000));
  EXPECT_TRUE(Read("9.1e9 0 0 0 0 0 0 1\n", &error).empty());
  const auto exponent = Read("1.7000000005e+09 0 0 0 0 0 0 1\n", &error);
  ASSERT_EQ(exponent.size(), 1U) << error;
  EXPECT_EQ(exponent[0].time, Time{} + milliseconds(1'700'000'000'500));
}

TEST(TrajectoryFiles, HaveRotationsOfAboutUnitLength) {
  std::string error;
  for (const auto& [w, good] :
       {std::pair<const char*, bool>{"0.4", false}, {"0.6", true}, {"1.9", true}, {"2.1", false}})
    EXPECT_EQ(!Read(std::string("1.0 0 0 0 0 0 0 ") + w + "\n", &error).empty(), good) << w;
}

TEST(KittiFiles, BeginAtZeroWhateverCommentsTheyHave) {
  std::ostringstream out;
  WriteKittiLine(out, At(1, 2, 0.5));
  std::string error;
  const Trajectory read = Read("# a comment\n" + out.str(), &error);
  ASSERT_EQ(read.size(), 1U) << error;
  EXPECT_EQ(read[0].time, Time{});
}

/// Returns a straight trajectory at 10 m/s. All lengths are multiplied by `scale`.
Trajectory Straight(int poses, double scale = 1) {
  Trajectory way;
  for (int i = 0; i < poses; ++i)
    way.push_back({Time{} + i * milliseconds(100), At(scale * i, 0, 0)});
  return way;
}

TEST(TrajectoryErrors, TellTheLargestBesideTheMean) {
  const Trajectory truth = Straight(101);
  Trajectory once_off = truth;
  once_off[50].pose.position.y() += 1;
  const auto error = Compare(truth, once_off);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->poses, 101U);  // This includes the first and the last pose.
  EXPECT_NEAR(error->ate_max_m, 1, 0.02);
  EXPECT_NEAR(error->ate_rmse_m, 0.1, 0.01);
  EXPECT_NEAR(error->length_m, 100, 1e-9);
  EXPECT_TRUE(Compare(Straight(3), Straight(3)));
  EXPECT_FALSE(Compare(Straight(2), Straight(2)));
}

TEST(TrajectoryErrors, TellTurnsInDegrees) {
  const Trajectory truth = Straight(100);
  Trajectory turning = truth;
  for (std::size_t i = 0; i < turning.size(); ++i)
    turning[i].pose = At(static_cast<double>(i), 0, 0.2 * static_cast<double>(i) * M_PI / 180);
  const auto error = Compare(truth, turning);
  ASSERT_TRUE(error);
  EXPECT_NEAR(error->rpe_rmse_deg, 2, 1e-6);  // in one second
}

TEST(TrajectoryErrors, TheEndIsSeenFromTheFirstSecond) {
  const Trajectory truth = Straight(200);
  Trajectory estimate = Straight(200, 1.1);
  for (StampedPose& p : estimate) p.pose = At(30, 40, 1) * p.pose;
  const auto error = Compare(truth, estimate);
  ASSERT_TRUE(error);
  // The first ten poses, which are at 4.5 m on average, are aligned. At the end, an error of 0.1 *
  // (199 m - 4.5 m) remains.
  EXPECT_NEAR(error->end_error_m, 19.45, 1e-6);
}

/// The mean drift of a stretch depends on the length of the stretch.
TEST(TrajectoryErrors, DriftIsMeasuredOverUpTo800Metres) {
  const Trajectory truth = Straight(802);
  Trajectory bent = truth;
  for (std::size_t i = 0; i < bent.size(); ++i) {
    const auto way = static_cast<double>(i);
    bent[i].pose.position.y() = std::pow(way / 100, 3);
  }
  const auto error = Compare(truth, bent);
  ASSERT_TRUE(error && error->drift);
  // The expected drift is the mean over all stretches of 100 m to 800 m. A stretch begins at every
  // tenth pose.
  double sum = 0;
  int count = 0;
  for (double stretch = 100; stretch <= 800; stretch += 100)
    for (double begin = 0; begin + stretch < 802; begin += 10, ++count)
      sum += (std::pow((begin + stretch) / 100, 3) - std::pow(begin / 100, 3)) / stretch;
  EXPECT_NEAR(*error->drift, sum / count, 1e-9);
}

}  // namespace
}  // namespace lidar::odometry
