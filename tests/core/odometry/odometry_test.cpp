// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests the odometry on synthetic drives. Each pose of a drive is known.
#include "src/odometry/odometry.h"

#include <gtest/gtest.h>

#include <cmath>

#include "src/odometry/trajectory_error.h"
#include "tests/core/odometry/true_drive.h"

namespace lidar::odometry {
namespace {

struct Followed {
  Trajectory truth;
  Trajectory estimate;
  std::vector<Tracking> tracking;
  std::vector<double> deviation_m;
};
/// Follows the first `scans` scans of the drive, except for the scans whose numbers are in
/// `missing`.
Followed Follow(Drive* drive, std::uint64_t scans, const OdometrySettings& settings,
                const std::vector<std::uint64_t>& missing = {}) {
  Odometry odometry(settings);
  Followed run;
  for (std::uint64_t i = 0; i < scans; ++i) {
    if (std::find(missing.begin(), missing.end(), i) != missing.end()) continue;
    const Estimate e = odometry.OnScan(drive->StartOf(i), kPeriod, drive->Scan(i));
    run.truth.push_back({e.time, drive->TruthAt(e.time)});
    run.estimate.push_back({e.time, e.pose});
    run.tracking.push_back(e.tracking);
    run.deviation_m.push_back(std::sqrt(e.covariance.topLeftCorner<3, 3>().trace()));
  }
  return run;
}

TEST(Odometry, FollowsADriveThroughAStreet) {
  Drive drive(synth::SceneKind::kStreet, 10);
  const Followed run = Follow(&drive, 80, {});
  const auto error = Compare(run.truth, run.estimate);
  ASSERT_TRUE(error);
  EXPECT_NEAR(error->length_m, 79, 1);
  EXPECT_LT(error->ate_rmse_m, 0.15);
  EXPECT_LT(error->rpe_rmse_m, 0.1);  // per ten metres
}

TEST(Odometry, FollowsASlowDriveThoughTheCirclesOnTheGroundMoveAlong) {
  Drive drive(synth::SceneKind::kStreet, 5);
  const Followed run = Follow(&drive, 30, {});
  const auto error = Compare(run.truth, run.estimate);
  ASSERT_TRUE(error);
  EXPECT_NEAR(error->length_m, 14.5, 0.2);
  EXPECT_LT(error->ate_rmse_m, 0.05);
  EXPECT_EQ(run.tracking.back(), Tracking::kTracking);
}

TEST(Odometry, FollowsASlowDriveThroughAFieldWhereLittleButTheGroundHasSurfaces) {
  for (const double speed : {2.0, 5.0}) {
    Drive drive(synth::SceneKind::kField, speed);
    const Followed run = Follow(&drive, 50, {});
    const auto error = Compare(run.truth, run.estimate);
    ASSERT_TRUE(error);
    EXPECT_LT(error->ate_rmse_m, 0.03 * error->length_m) << speed;
    EXPECT_EQ(run.tracking.back(), Tracking::kTracking);
  }
}

TEST(Odometry, DoesNotWanderWhereLittleButTheGroundHoldsManyBeams) {
  constexpr std::uint64_t kFirst = 215;
  Drive drive(Drive::Config(synth::SceneKind::kField, 14, 14, "os1-64", 1024));
  Odometry odometry({});
  Trajectory truth;
  Trajectory estimate;
  for (std::uint64_t i = kFirst; i < kFirst + 40; ++i) {
    const Estimate e = odometry.OnScan(drive.StartOf(i), kPeriod, drive.Scan(i));
    truth.push_back({e.time, drive.TruthAt(e.time)});
    estimate.push_back({e.time, e.pose});
    EXPECT_EQ(e.tracking, i > kFirst ? Tracking::kTracking : Tracking::kStarted) << i;
  }
  const auto error = Compare(truth, estimate);
  ASSERT_TRUE(error);
  EXPECT_LT(error->ate_rmse_m, 0.07);
  EXPECT_LT(error->rpe_rmse_m, 0.085);
}

TEST(Odometry, DoesNotTiltOnGroundThatItSawFromAfar) {
  Drive drive(Drive::Config(synth::SceneKind::kField, 7, 136, "os0-32", 1024));
  const Followed run = Follow(&drive, 60, {});
  const auto error = Compare(run.truth, run.estimate);
  ASSERT_TRUE(error);
  EXPECT_LT(error->end_error_m, 0.3);
}

/// The results of a drive round the corners of a town, or over the bumps of a field.
struct GyroRun {
  double ate_m = 0;
  std::size_t lost = 0;
};
GyroRun FollowWithGyro(Drive* drive, std::uint64_t scans, bool gaps, bool gyro,
                       double axes_rad = 0) {
  Odometry odometry({});
  Trajectory truth;
  Trajectory estimate;
  GyroRun run;
  synth::Imu imu = drive->Imu();
  for (std::uint64_t i = 0; i < scans; ++i) {
    const Time start = drive->StartOf(i);
    if (gyro) AddTurns(&imu, start + kPeriod, axes_rad, &odometry);
    if (gaps && i % 30 >= 20) continue;  // leaves out one second in three
    const Estimate e = odometry.OnScan(start, kPeriod, drive->Scan(i));
    run.lost += e.tracking == Tracking::kLost ? 1 : 0;
    truth.push_back({e.time, drive->TruthAt(e.time)});
    estimate.push_back({e.time, e.pose});
  }
  const auto error = Compare(truth, estimate);
  run.ate_m = error ? error->ate_rmse_m : 1e9;
  return run;
}

TEST(Odometry, FollowsCornersAndBumpsOverGapsOfASecondByAGyroscope) {
  for (const auto scene : {synth::SceneKind::kTown, synth::SceneKind::kField}) {
    Drive drive(scene, 12, 3);
    const GyroRun smooth = FollowWithGyro(&drive, 80, false, false);
    const GyroRun gaps = FollowWithGyro(&drive, 80, true, true);
    EXPECT_LE(gaps.ate_m, 2 * smooth.ate_m);
    EXPECT_EQ(gaps.lost, 0U);
  }
}

TEST(Odometry, IsNotMisledByAGyroscopeWhoseAxesAreTurned) {
  Drive drive(synth::SceneKind::kTown, 12, 3);
  const GyroRun without = FollowWithGyro(&drive, 40, false, false);
  const GyroRun turned = FollowWithGyro(&drive, 40, false, true, 1.6);
  EXPECT_LE(turned.ate_m, 2 * without.ate_m + 0.01);
  EXPECT_EQ(turned.lost, 0U);
}

TEST(Odometry, FollowsADriveOfWhichItKnowsNoBeams) {
  Drive drive(synth::SceneKind::kStreet, 10);
  Odometry odometry({});
  Pose pose;
  for (std::uint64_t i = 0; i < 20; ++i) {
    TimedPoints scan = drive.Scan(i);
    scan.rings.clear();
    pose = odometry.OnScan(drive.StartOf(i), kPeriod, scan).pose;
  }
  EXPECT_NEAR(pose.position.norm(), 19, 0.3);
}

TEST(Odometry, IsWorseWithoutDeskewing) {
  Drive drive(synth::SceneKind::kStreet, 20);
  OdometrySettings rigid;
  rigid.deskew = false;
  const Followed straightened = Follow(&drive, 40, {});
  const Followed skewed = Follow(&drive, 40, rigid);
  const auto with = Compare(straightened.truth, straightened.estimate);
  const auto without = Compare(skewed.truth, skewed.estimate);
  ASSERT_TRUE(with && without);
  EXPECT_LT(with->rpe_rmse_m, without->rpe_rmse_m);
  EXPECT_LT(with->ate_rmse_m, 0.5);  // The car already had 20 m/s at the start.
}

TEST(Odometry, SpansMissingScansAtConstantVelocity) {
  Drive drive(synth::SceneKind::kStreet, 10);
  const Followed run = Follow(&drive, 60, {}, {20, 21, 22, 30, 31, 32, 33, 34, 35, 36});
  const auto error = Compare(run.truth, run.estimate);
  ASSERT_TRUE(error);
  EXPECT_LT(error->ate_rmse_m, 0.2);
}

TEST(Odometry, StandsStillWithTheSensor) {
  Drive drive(synth::SceneKind::kStreet, 0);
  const Followed run = Follow(&drive, 30, {});
  EXPECT_LT(run.estimate.back().pose.position.norm(), 0.02);
  EXPECT_EQ(run.tracking.back(), Tracking::kTracking);
}

TEST(Odometry, SaysThatATunnelHidesTheMotionAndInventsNone) {
  Drive standing(synth::SceneKind::kTunnel, 0);
  const Followed run = Follow(&standing, 20, {});
  EXPECT_LT(run.estimate.back().pose.position.norm(), 0.05);
  Drive driving(synth::SceneKind::kTunnel, 10);
  const Followed blind = Follow(&driving, 30, {});
  const auto degenerate =
      std::count(blind.tracking.begin(), blind.tracking.end(), Tracking::kDegenerate);
  EXPECT_GT(degenerate, 20);
}

TEST(Odometry, GoesOnAtTheVelocityThatItIsGiven) {
  Drive drive(synth::SceneKind::kStreet, 20);
  OdometrySettings settings;
  settings.start_velocity = Twist::Unit(0) * 20;
  Odometry odometry(settings);
  const Estimate first = odometry.OnScan(drive.StartOf(0), kPeriod, drive.Scan(0));
  EXPECT_NEAR(first.pose.position.norm(), 0, 1e-9);
  EXPECT_NEAR(odometry.PredictAt(first.time + kPeriod).position.x(), 2, 1e-9);
  EXPECT_NEAR(Odometry({}).PredictAt(first.time + kPeriod).position.x(), 0, 1e-9);
  const Estimate second = odometry.OnScan(drive.StartOf(1), kPeriod, drive.Scan(1));
  EXPECT_NEAR(second.pose.position.x(), 2, 0.1) << "the first scan is straight";
}

/// Returns the error of the last position, measured from the first pose.
double EndError(const Followed& run) {
  const Pose way = run.truth.front().pose.Inverse() * run.truth.back().pose;
  const Pose found = run.estimate.front().pose.Inverse() * run.estimate.back().pose;
  return (way.position - found.position).norm();
}

TEST(Odometry, LosesNoStartInOpenCountry) {
  for (const std::uint64_t seed : {11U, 22U}) {
    Drive drive(synth::SceneKind::kField, 7, seed);
    const Followed run = Follow(&drive, 12, {});
    EXPECT_EQ(std::count(run.tracking.begin() + 1, run.tracking.end(), Tracking::kTracking), 11)
        << seed;
  }
}

TEST(Odometry, SaysHowFarItMayBeOff) {
  for (const auto scene :
       {synth::SceneKind::kStreet, synth::SceneKind::kField, synth::SceneKind::kTunnel}) {
    Drive drive(scene, 8);
    const Followed run = Follow(&drive, 30, {});
    EXPECT_LT(EndError(run), 3 * run.deviation_m.back());
    const double most = scene == synth::SceneKind::kTunnel ? 60 : 2;  // The drive is 23 m long.
    EXPECT_LT(run.deviation_m.back(), most);
  }
}

TEST(Odometry, IsLessSureOfWhatItDoesNotSee) {
  Drive street(synth::SceneKind::kStreet, 8);
  Drive tunnel(synth::SceneKind::kTunnel, 8);
  EXPECT_GT(Follow(&tunnel, 20, {}).deviation_m.back(),
            10 * Follow(&street, 20, {}).deviation_m.back());
}

TEST(Odometry, TellsItsErrorInTheAxesOfTheMap) {
  Drive tunnel(synth::SceneKind::kTunnel, 8);
  OdometrySettings turned;
  turned.start.rotation = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ());
  Odometry odometry(turned);
  Estimate estimate;
  for (std::uint64_t i = 0; i < 10; ++i)
    estimate = odometry.OnScan(tunnel.StartOf(i), kPeriod, tunnel.Scan(i));
  EXPECT_GT(estimate.covariance(1, 1), 10 * estimate.covariance(0, 0)) << "along the tunnel";
}

TEST(Odometry, FollowsThroughATownOfHillsAndCorners) {
  Drive drive(synth::SceneKind::kTown, 12);
  const Followed run = Follow(&drive, 40, {});
  const auto error = Compare(run.truth, run.estimate);
  ASSERT_TRUE(error);
  EXPECT_LT(error->ate_rmse_m, 0.2);
}

TEST(Odometry, KeepsItsMapBounded) {
  Drive drive(synth::SceneKind::kField, 30);
  OdometrySettings settings;
  settings.max_range_m = 40;
  Odometry odometry(settings);
  std::size_t most = 0;
  for (std::uint64_t i = 0; i < 60; ++i) {
    odometry.OnScan(drive.StartOf(i), kPeriod, drive.Scan(i));
    if (i == 20) most = odometry.map().voxels();
  }
  EXPECT_LT(odometry.map().voxels(), 2 * most);
}

}  // namespace
}  // namespace lidar::odometry
