// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/odometry/turn_history.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lidar::odometry {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kStep = milliseconds(10);
constexpr Duration kScan = milliseconds(100);

Eigen::Quaterniond Turn(double yaw) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
}
double YawOf(const Eigen::Quaterniond& turn) {
  return Log({turn, Eigen::Vector3d::Zero()}).tail<3>().z();
}
void AddSteadyTurn(Time from, Time to, double rate, TurnHistory* turns) {
  for (Time t = from; t <= to; t += kStep) turns->Add(t, {0, 0, rate});
}
/// Adds a second with the angular velocity `measured`. Teaches ten scans in which the sensor turned
/// at 1 rad/s, although half of that was predicted.
void TeachTurns(double measured, TurnHistory* turns) {
  AddSteadyTurn(Time{}, Time{} + seconds(1), measured, turns);
  for (int i = 0; i < 10; ++i)
    turns->Teach(Time{} + i * kScan, Time{} + (i + 1) * kScan, Turn(0.1), Turn(0.05));
}

TEST(TurnHistory, AddsUpATurn) {
  TurnHistory turns;
  AddSteadyTurn(Time{}, Time{} + seconds(1), 0.5, &turns);
  const auto turn = turns.Between(Time{} + milliseconds(203), Time{} + milliseconds(707));
  ASSERT_TRUE(turn);
  EXPECT_NEAR(YawOf(*turn), 0.252, 1e-9);
}

TEST(TurnHistory, FollowsARateThatRises) {
  TurnHistory turns;
  for (int i = 0; i <= 100; ++i) turns.Add(Time{} + i * kStep, {0, 0, 0.01 * i});
  // The expected turn is the integral of the time from 0.203 s to 0.208 s. Both limits are between
  // two samples.
  const auto turn = turns.Between(Time{} + milliseconds(203), Time{} + milliseconds(208));
  ASSERT_TRUE(turn);
  EXPECT_NEAR(YawOf(*turn), (0.208 * 0.208 - 0.203 * 0.203) / 2, 1e-9);
}

TEST(TurnHistory, KnowsNothingBeforeOrAfterItsSamplesOrOverAGap) {
  TurnHistory turns;
  EXPECT_FALSE(turns.Between(Time{}, Time{} + kScan));
  AddSteadyTurn(Time{} + seconds(1), Time{} + seconds(2), 1, &turns);
  AddSteadyTurn(Time{} + milliseconds(2100), Time{} + seconds(3), 1, &turns);
  EXPECT_FALSE(turns.Between(Time{}, Time{} + seconds(2)));
  EXPECT_FALSE(turns.Between(Time{} + seconds(2), Time{} + seconds(4)));
  EXPECT_FALSE(turns.Between(Time{} + milliseconds(1900), Time{} + milliseconds(2200)));
  EXPECT_TRUE(turns.Between(Time{} + milliseconds(2200), Time{} + milliseconds(3040)))
      << "the samples of the last slice may be on their way";
  EXPECT_FALSE(turns.Between(Time{} + milliseconds(3200), Time{} + milliseconds(3210)));
  EXPECT_FALSE(turns.Between(Time{} + milliseconds(790), Time{} + milliseconds(800)));
}

TEST(TurnHistory, DropsTimesThatRepeatOrGoBackAndFollowsANewClock) {
  TurnHistory turns;
  AddSteadyTurn(Time{} + seconds(100), Time{} + seconds(101), 1, &turns);
  turns.Add(Time{} + seconds(101), {0, 0, 9});
  turns.Add(Time{} + milliseconds(100'500), {0, 0, 9});
  EXPECT_NEAR(YawOf(*turns.Between(Time{} + seconds(100), Time{} + seconds(101))), 1, 1e-9);
  AddSteadyTurn(Time{}, Time{} + seconds(1), 2, &turns);
  EXPECT_NEAR(YawOf(*turns.Between(Time{}, Time{} + seconds(1))), 2, 1e-9);
  EXPECT_FALSE(turns.Between(Time{} + seconds(100), Time{} + seconds(101)));
}

TEST(TurnHistory, DropsWhatNoGyroscopeMeasures) {
  TurnHistory turns;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  turns.Add(Time{}, {nan, 0, 0});
  turns.Add(Time{} + kStep, {0, 0, 1e9});
  turns.Add(Time{} + kStep, {0, 0, 0}, {0, nan, 0});
  turns.Add(Time{} + kStep, {0, 0, 0}, {0, 0, 1e9});
  EXPECT_FALSE(turns.Between(Time{}, Time{} + kStep));
}

TEST(TurnHistory, TrustsAGyroscopeThatForetellsTurns) {
  TurnHistory turns;
  EXPECT_FALSE(turns.trusted());
  TeachTurns(1, &turns);
  EXPECT_TRUE(turns.trusted());
}

TEST(TurnHistory, DoesNotTrustTurnedAxesOrWrongUnits) {
  TurnHistory upside_down;
  TeachTurns(-1, &upside_down);
  EXPECT_FALSE(upside_down.trusted());
  TurnHistory degrees;
  TeachTurns(57.3 / 2, &degrees);
  EXPECT_FALSE(degrees.trusted());
}

TEST(TurnHistory, LearnsItsBias) {
  TurnHistory turns;
  AddSteadyTurn(Time{}, Time{} + seconds(10), 0.03, &turns);
  for (int i = 0; i < 99; ++i)
    turns.Teach(Time{} + i * kScan, Time{} + (i + 1) * kScan, Turn(0), Turn(0));
  EXPECT_NEAR(turns.bias().z(), 0.03, 0.001);
  EXPECT_NEAR(YawOf(*turns.Between(Time{}, Time{} + seconds(1))), 0, 0.001);
}

TEST(TurnHistory, BelievesNoBiasThatNoGyroscopeHas) {
  TurnHistory turns;
  AddSteadyTurn(Time{}, Time{} + seconds(10), 1, &turns);
  for (int i = 0; i < 99; ++i)
    turns.Teach(Time{} + i * kScan, Time{} + (i + 1) * kScan, Turn(0), Turn(0));
  EXPECT_LE(turns.bias().norm(), 0.2 + 1e-9);
}

/// A sensor that drives at 10 m/s on a road with five bumps per second.
struct BumpyRoad {
  static constexpr double kTurns = 31.4;  // [rad/s]
  static constexpr double kHeight = 0.04;
  static constexpr double kGravity = 9.8;

  static Moving At(double t) {
    Moving at;
    at.pose.position = {10 * t, 0, kHeight * std::sin(kTurns * t)};
    at.velocity.head<3>() << 10, 0, kHeight * kTurns * std::cos(kTurns * t);
    return at;
  }
  /// Drives along the road. The third axis of the accelerometer is wrong by the factor `axis`.
  static void Drive(double axis, TurnHistory* turns) {
    for (int i = 0; i <= 1000; ++i) {
      const double t = 0.002 * i;
      const double up = kGravity - kHeight * kTurns * kTurns * std::sin(kTurns * t);
      turns->Add(Time{} + i * milliseconds(2), {0, 0, 0}, {0, 0, axis * up});
    }
    for (int i = 0; i < 19; ++i) {
      turns->Teach(Time{} + i * kScan, Time{} + (i + 1) * kScan, Turn(0), Turn(0));
      turns->TeachForce(Time{} + i * kScan, Time{} + (i + 1) * kScan, At(0.1 * i),
                        At(0.1 * i + 0.1));
    }
  }
};

TEST(TurnHistory, FollowsBumpsByTheirForcesInBothDirectionsOfTime) {
  TurnHistory turns;
  BumpyRoad::Drive(1, &turns);
  ASSERT_TRUE(turns.force_trusted());
  for (const int ms : {1830, 1870, 1900, 1960}) {
    const Moving there = BumpyRoad::At(0.001 * ms);
    const auto moved =
        turns.Move(BumpyRoad::At(1.9), Time{} + milliseconds(1900), Time{} + milliseconds(ms));
    ASSERT_TRUE(moved);
    EXPECT_LT((moved->pose.position - there.pose.position).norm(), 0.002) << ms;
    EXPECT_LT((moved->velocity - there.velocity).norm(), 0.05) << ms;
  }
}

TEST(TurnHistory, TurnsForcesWithTheSensor) {
  // The sensor drives on a circle with a radius of 5 m at 10 m/s, in the plane of the first two
  // axes.
  TurnHistory turns;
  const auto at = [](double t) {
    Moving state;
    state.pose = {Turn(2 * t), {5 * std::sin(2 * t), 5 - 5 * std::cos(2 * t), 0}};
    state.velocity.head<3>() << 10, 0, 0;
    return state;
  };
  for (int i = 0; i <= 1000; ++i)
    turns.Add(Time{} + i * milliseconds(2), {0, 0, 2}, {0, 20, BumpyRoad::kGravity});
  for (int i = 0; i < 19; ++i) {
    turns.Teach(Time{} + i * kScan, Time{} + (i + 1) * kScan, Turn(0.2), Turn(0.2));
    turns.TeachForce(Time{} + i * kScan, Time{} + (i + 1) * kScan, at(0.1 * i), at(0.1 * i + 0.1));
  }
  for (const int ms : {1500, 1850, 1950}) {
    const auto moved = turns.Move(at(1.9), Time{} + milliseconds(1900), Time{} + milliseconds(ms));
    ASSERT_TRUE(moved);
    EXPECT_LT((moved->pose.position - at(0.001 * ms).pose.position).norm(), 0.002) << ms;
    EXPECT_LT((moved->velocity - at(0.001 * ms).velocity).norm(), 0.01) << ms;
  }
}

TEST(TurnHistory, DoesNotTrustForcesOfReversedAxes) {
  TurnHistory turns;
  BumpyRoad::Drive(-1, &turns);
  EXPECT_TRUE(turns.trusted());
  EXPECT_FALSE(turns.force_trusted());
  EXPECT_FALSE(turns.Move(BumpyRoad::At(1), Time{} + seconds(1), Time{} + milliseconds(1100)));
}

TEST(TurnHistory, KeepsTenSeconds) {
  TurnHistory turns;
  AddSteadyTurn(Time{}, Time{} + seconds(30), 1, &turns);
  EXPECT_TRUE(turns.Between(Time{} + seconds(21), Time{} + seconds(30)));
  EXPECT_FALSE(turns.Between(Time{} + seconds(19), Time{} + seconds(30)));
}

}  // namespace
}  // namespace lidar::odometry
