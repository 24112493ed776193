// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests motions and sensors that do not belong to a driving car.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "src/odometry/odometry.h"
#include "tests/core/odometry/true_drive.h"

namespace lidar::odometry {
namespace {

void AddSteadyTurn(Time from, Time to, double rate, Odometry* odometry) {
  for (Time t = from; t < to; t += std::chrono::milliseconds(10)) odometry->OnTurn(t, {0, 0, rate});
}

TEST(OddMotion, ScansOfAnotherSensorBetweenAreLostAndTheOthersAreNot) {
  Drive drive(synth::SceneKind::kStreet, 10);
  const Pose mount{Eigen::Quaterniond(Eigen::AngleAxisd(1.5, Eigen::Vector3d::UnitZ())),
                   {0.5, 1, -0.4}};
  Odometry odometry({});
  Estimate last;
  for (std::uint64_t i = 0; i < 40; ++i) {
    TimedPoints scan = drive.Scan(i);
    const bool other = i > 10 && i % 3 == 0;
    if (other)
      for (Eigen::Vector3d& point : scan.points) point = mount.Inverse() * point;
    const Estimate e = odometry.OnScan(drive.StartOf(i), kPeriod, scan);
    EXPECT_EQ(e.tracking == Tracking::kLost, other) << i;
    EXPECT_FALSE(e.map_restarted);
    if (!other) last = e;
  }
  EXPECT_LT((last.pose.position - drive.WayTo(38).position).norm(), 0.5);
}

/// A sensor whose view is a quarter of the horizon turns on the spot.
TEST(OddMotion, ATurnBringsANarrowViewIntoTheMap) {
  std::minstd_rand random(5);
  std::uniform_real_distribution<double> share(0, 1);
  Points world;
  for (int box = 0; box < 120; ++box) {
    const double at = 2 * M_PI * (box + 0.5 * share(random)) / 120;
    const double far = 6 + 12 * share(random), wide = 0.5 + share(random), high = 4 * share(random);
    const Eigen::Vector3d corner(far * std::cos(at), far * std::sin(at), -1.5);
    for (double a = 0; a < wide; a += 0.3)
      for (double z = 0; z < 1 + high; z += 0.3) {
        world.push_back(corner + Eigen::Vector3d(a, 0, z));
        world.push_back(corner + Eigen::Vector3d(0, a, z));
      }
  }
  for (double x = -18; x < 18; x += 1)
    for (double y = -18; y < 18; y += 1) world.emplace_back(x, y, -1.5);
  OdometrySettings settings;
  settings.deskew = false;
  Odometry odometry(settings);
  constexpr double kTurn = 0.06;  // in radians per scan
  for (int scan = 0; scan < 50; ++scan) {
    const Pose pose{Eigen::Quaterniond(Eigen::AngleAxisd(kTurn * scan, Eigen::Vector3d::UnitZ())),
                    Eigen::Vector3d::Zero()};
    TimedPoints seen;
    for (const Eigen::Vector3d& point : world) {
      const Eigen::Vector3d p = pose.Inverse() * point;
      if (std::abs(std::atan2(p.y(), p.x())) < M_PI / 4) seen.points.push_back(p);
    }
    const Estimate e = odometry.OnScan(Time{} + kPeriod * scan, kPeriod, seen);
    EXPECT_NE(e.tracking, Tracking::kLost) << scan;
    EXPECT_LT(Angle(pose.Inverse() * e.pose), 0.05) << scan;
  }
}

TEST(OddMotion, AGyroscopeMayStop) {
  Drive drive(synth::SceneKind::kTown, 12, 3);
  Odometry odometry({});
  synth::Imu imu = drive.Imu();
  int measured = 0;
  double off = 0;
  for (std::uint64_t i = 0; i < 50; ++i) {
    const Time start = drive.StartOf(i);
    if (i < 25) AddTurns(&imu, start + kPeriod, 0, &odometry);
    const Estimate e = odometry.OnScan(start, kPeriod, drive.Scan(i));
    EXPECT_EQ(e.tracking, i == 0 ? Tracking::kStarted : Tracking::kTracking) << i;
    measured += e.turn_measured ? 1 : 0;
    off = (e.pose.position - drive.WayTo(i).position).norm();
  }
  EXPECT_GE(measured, 15);
  EXPECT_LE(measured, 25);
  EXPECT_LT(off, 0.2);
}

/// The sensor stands on the deck of a ship that turns. The gyroscope measures the turn, although
/// the surroundings on the deck do not move.
TEST(OddMotion, AFerryIsTheWorld) {
  Drive deck(synth::SceneKind::kStreet, 0);
  Odometry odometry({});
  Estimate e;
  for (std::uint64_t i = 0; i < 40; ++i) {
    const Time start = deck.StartOf(i);
    AddSteadyTurn(start, start + kPeriod, i < 10 ? 0 : 0.1, &odometry);
    e = odometry.OnScan(start, kPeriod, deck.Scan(i));
    EXPECT_NE(e.tracking, Tracking::kLost) << i;
  }
  EXPECT_LT(e.pose.position.norm(), 0.05);
  EXPECT_LT(Angle(e.pose), 0.01);
}

/// Turns the points of a sensor at rest as if the sensor had turned at `rate` since the first scan.
TimedPoints TurnedScan(Drive* drive, std::uint64_t number, double rate) {
  TimedPoints scan = drive->Scan(number);
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const double t =
        Seconds(kPeriod) * (static_cast<double>(number) + static_cast<double>(scan.phases[i]));
    scan.points[i] = Eigen::AngleAxisd(-rate * t, Eigen::Vector3d::UnitZ()) * scan.points[i];
  }
  return scan;
}

class Turntables : public testing::TestWithParam<double> {};

TEST_P(Turntables, MayTurnFromTheStart) {
  Drive place(synth::SceneKind::kStreet, 0);
  Odometry odometry({});
  Estimate e;
  for (std::uint64_t i = 0; i < 20; ++i) {
    e = odometry.OnScan(place.StartOf(i), kPeriod, TurnedScan(&place, i, GetParam()));
    EXPECT_NE(e.tracking, Tracking::kLost) << i;
  }
  EXPECT_LT(e.pose.position.norm(), 0.1);
  const Pose expected = Exp((Twist() << 0, 0, 0, 0, 0, GetParam() * 1.9).finished());
  EXPECT_LT(Angle(expected.Inverse() * e.pose), 0.02);
}

INSTANTIATE_TEST_SUITE_P(Rates, Turntables, testing::Values(0.2, 0.5, 1.0));

}  // namespace
}  // namespace lidar::odometry
