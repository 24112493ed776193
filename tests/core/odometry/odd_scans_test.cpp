// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests scans that do not fit the map, that come late, or that belong to no drive.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "src/odometry/odometry.h"
#include "tests/core/odometry/true_drive.h"

namespace lidar::odometry {
namespace {

using std::chrono::milliseconds;

TEST(OddScans, StartsAfreshBesideAMapToWhichNothingHasFitted) {
  Drive street(synth::SceneKind::kStreet, 10);
  Odometry odometry({});
  TimedPoints elsewhere = street.Scan(0);
  for (Eigen::Vector3d& point : elsewhere.points) point.z() += 40;
  odometry.OnScan(street.StartOf(0), kPeriod, elsewhere);
  const Estimate fresh = odometry.OnScan(street.StartOf(1), kPeriod, street.Scan(1));
  EXPECT_EQ(fresh.tracking, Tracking::kStarted);
  EXPECT_TRUE(fresh.map_restarted);
  const Estimate next = odometry.OnScan(street.StartOf(2), kPeriod, street.Scan(2));
  EXPECT_EQ(next.tracking, Tracking::kTracking);
  EXPECT_NEAR((next.pose.position - fresh.pose.position).norm(), 1, 0.1);
}

TEST(OddScans, IsLostWhereAVehicleCannotHaveMovedLikeThat) {
  // If true, the odometry is lost at scan 8 and tracks again afterwards.
  for (const bool was_lost : {false, true}) {
    Drive street(synth::SceneKind::kStreet, 10);
    Odometry odometry({});
    for (std::uint64_t i = 0; i < 10; ++i) {
      TimedPoints scan = street.Scan(i);
      const bool elsewhere = was_lost && i == 8;
      for (Eigen::Vector3d& point : scan.points) point.z() += elsewhere ? 40 : 0;
      const Estimate e = odometry.OnScan(street.StartOf(i), kPeriod, scan);
      EXPECT_EQ(e.tracking == Tracking::kLost, elsewhere) << i;
    }
    const Pose before = odometry.PredictAt(street.StartOf(10) + kPeriod / 2);
    TimedPoints aside = street.Scan(10);
    for (Eigen::Vector3d& point : aside.points) point.y() += 1;
    const Estimate lost = odometry.OnScan(street.StartOf(10), kPeriod, aside);
    EXPECT_EQ(lost.tracking, Tracking::kLost) << was_lost;
    EXPECT_LT((lost.pose.position - before.position).norm(), 1e-9) << was_lost;
  }
}

TEST(OddScans, KnowsWhenAScanDoesNotFit) {
  Drive street(synth::SceneKind::kStreet, 10);
  Odometry odometry({});
  for (std::uint64_t i = 0; i < 10; ++i)
    odometry.OnScan(street.StartOf(i), kPeriod, street.Scan(i));
  const Pose before = odometry.PredictAt(street.StartOf(10));
  TimedPoints elsewhere = street.Scan(10);
  for (Eigen::Vector3d& point : elsewhere.points) point.z() += 40;
  const Estimate lost = odometry.OnScan(street.StartOf(10), kPeriod, elsewhere);
  EXPECT_EQ(lost.tracking, Tracking::kLost);
  EXPECT_LT((lost.pose.position - before.position).norm(), 1.0);
  const Estimate later = odometry.OnScan(street.StartOf(11), kPeriod, elsewhere);
  EXPECT_GT(later.covariance(0, 0), 1.5 * lost.covariance(0, 0));
  const Estimate found = odometry.OnScan(street.StartOf(12), kPeriod, street.Scan(12));
  EXPECT_EQ(found.tracking, Tracking::kTracking);
}

/// A jump to another place in a scene that looks similar everywhere.
struct Jump {
  synth::SceneKind scene;
  const char* sensor;
};
class OdometryJumps : public testing::TestWithParam<Jump> {};

TEST_P(OdometryJumps, AreSeenWithinASecond) {
  Drive before(Drive::Config(GetParam().scene, 10, 7, GetParam().sensor));
  Drive after(Drive::Config(GetParam().scene, 10, 9, GetParam().sensor));
  Odometry odometry({});
  bool seen = false;
  for (std::uint64_t i = 0; i < 40; ++i) {
    Drive& drive = i < 30 ? before : after;
    const Estimate e = odometry.OnScan(before.StartOf(i), kPeriod, drive.Scan(i));
    if (i < 30)
      EXPECT_NE(e.tracking, Tracking::kLost) << i;
    else
      seen |= e.tracking == Tracking::kLost;
  }
  EXPECT_TRUE(seen);
}

INSTANTIATE_TEST_SUITE_P(Scenes, OdometryJumps,
                         testing::Values(Jump{synth::SceneKind::kStreet, "os0-32"},
                                         Jump{synth::SceneKind::kTown, "os0-32"},
                                         Jump{synth::SceneKind::kStreet, "os1-64"},
                                         Jump{synth::SceneKind::kTown, "os1-64"},
                                         Jump{synth::SceneKind::kField, "os0-32"},
                                         Jump{synth::SceneKind::kField, "os1-64"}));

TEST(OddScans, FindsItsWayAfterTwoScansOfTheSameTime) {
  Drive street(synth::SceneKind::kStreet, 10);
  Odometry odometry({});
  for (std::uint64_t i = 0; i < 5; ++i) odometry.OnScan(street.StartOf(i), kPeriod, street.Scan(i));
  odometry.OnScan(street.StartOf(4) + std::chrono::nanoseconds(1), kPeriod, street.Scan(5));
  const Estimate next = odometry.OnScan(street.StartOf(6), kPeriod, street.Scan(6));
  EXPECT_EQ(next.tracking, Tracking::kTracking);
  EXPECT_NEAR(next.pose.position.norm(), 6, 0.5);
}

TEST(OddScans, BeginsANewMapWhereItIsLostForGood) {
  Drive street(synth::SceneKind::kStreet, 10);
  Odometry odometry({});
  std::uint64_t i = 0;
  for (; i < 5; ++i) odometry.OnScan(street.StartOf(i), kPeriod, street.Scan(i));
  TimedPoints elsewhere = street.Scan(5);
  for (Eigen::Vector3d& point : elsewhere.points) point.z() += 40;
  Estimate e;
  for (; i < 16; ++i) e = odometry.OnScan(street.StartOf(i), kPeriod, elsewhere);
  EXPECT_TRUE(e.map_restarted || e.tracking == Tracking::kTracking);
  e = odometry.OnScan(street.StartOf(i), kPeriod, elsewhere);
  EXPECT_EQ(e.tracking, Tracking::kTracking);
  EXPECT_LT(odometry.PredictAt(street.StartOf(i + 1)).position.norm(), 20);
}

/// Returns the deviation along x behind a scan that fits nothing [m].
double DeviationOfALostScan(Drive* drive, std::uint64_t number, Odometry* odometry) {
  TimedPoints nowhere = drive->Scan(number);
  for (Eigen::Vector3d& point : nowhere.points) point.z() += 400;
  const Estimate lost = odometry->OnScan(drive->StartOf(number), kPeriod, nowhere);
  return std::sqrt(lost.covariance(0, 0));
}

TEST(OddScans, ForgetsTheVelocityThatLedToALoss) {
  Drive street(synth::SceneKind::kStreet, 10);
  Odometry odometry({});
  std::uint64_t i = 0;
  for (; i < 5; ++i) odometry.OnScan(street.StartOf(i), kPeriod, street.Scan(i));
  Estimate e;
  while (!e.map_restarted && i < 40) {
    TimedPoints elsewhere = street.Scan(5);
    for (Eigen::Vector3d& point : elsewhere.points) point.z() += i % 2 == 0 ? 40 : 80;
    e = odometry.OnScan(street.StartOf(i), kPeriod, elsewhere);
    ++i;
  }
  ASSERT_TRUE(e.map_restarted);
  const Pose later = odometry.PredictAt(e.time + std::chrono::seconds(1));
  EXPECT_LT((later.position - e.pose.position).norm(), 1e-9) << "it stands until scans show more";
  EXPECT_GT(DeviationOfALostScan(&street, i, &odometry), 1.4) << "it may drive 15 m/s";
}

TEST(OddScans, PredictsNothingForATimeThatIsFarAway) {
  Drive street(synth::SceneKind::kStreet, 10);
  Odometry odometry({});
  Estimate e;
  for (std::uint64_t i = 0; i < 5; ++i)
    e = odometry.OnScan(street.StartOf(i), kPeriod, street.Scan(i));
  for (const Time t : {e.time + std::chrono::minutes(1), e.time - std::chrono::minutes(1)})
    EXPECT_LT((odometry.PredictAt(t).position - e.pose.position).norm(), 1e-9);
}

TEST(OddScans, FindsItsWayAfterLostScansInWhichTheCarBraked) {
  Drive drive(synth::SceneKind::kTown, 10);
  Odometry odometry({});
  for (std::uint64_t i = 0; i < 20; ++i) odometry.OnScan(drive.StartOf(i), kPeriod, drive.Scan(i));
  TimedPoints elsewhere = drive.Scan(20);
  for (Eigen::Vector3d& point : elsewhere.points) point.z() += 40;
  for (std::uint64_t i = 20; i < 25; ++i)
    EXPECT_EQ(odometry.OnScan(drive.StartOf(i), kPeriod, elsewhere).tracking, Tracking::kLost);
  // In 0.6 s, the sensor moves only as far as it did in each 0.5 s before. This is 1 m less than
  // predicted.
  const Estimate found = odometry.OnScan(drive.StartOf(25), kPeriod, drive.Scan(24));
  EXPECT_EQ(found.tracking, Tracking::kTracking);
  EXPECT_LT((found.pose.position - drive.WayTo(24).position).norm(), 0.3);
}

/// A large hall. The sensor sees only the walls and the edge of the floor.
TEST(OddScans, FollowsWhereAllIsFarAway) {
  Points hall;
  for (double along = -50; along < 50; along += 0.5)
    for (double z = -1.5; z < 10; z += 0.5)
      for (const double side : {-50.2, 50.2}) {
        hall.emplace_back(side, along, z);
        hall.emplace_back(along, side, z);
      }
  for (double x = -50; x < 50; x += 0.5)
    for (double y = -50; y < 50; y += 0.5)
      if (std::hypot(x, y) > 44) hall.emplace_back(x, y, -1.5);
  Odometry odometry({});
  for (int scan = 0; scan < 6; ++scan) {
    const Eigen::Vector3d place(0.5 * scan, 0, 0);
    TimedPoints seen;
    for (const Eigen::Vector3d& point : hall) seen.points.push_back(point - place);
    const Estimate e = odometry.OnScan(Time{} + kPeriod * scan, kPeriod, seen);
    EXPECT_EQ(e.tracking, scan == 0 ? Tracking::kStarted : Tracking::kTracking) << scan;
    EXPECT_LT((e.pose.position - place).norm(), 0.05) << scan;
  }
}

TEST(OddScans, BeginsANewMapAfterALongGap) {
  Drive street(synth::SceneKind::kStreet, 10);
  Odometry odometry({});
  for (std::uint64_t i = 0; i < 5; ++i) odometry.OnScan(street.StartOf(i), kPeriod, street.Scan(i));
  const Estimate later = odometry.OnScan(street.StartOf(100), kPeriod, street.Scan(100));
  EXPECT_EQ(later.tracking, Tracking::kStarted);
  EXPECT_TRUE(later.map_restarted);
  const Pose predicted = odometry.PredictAt(later.time + std::chrono::seconds(1));
  EXPECT_LT((predicted.position - later.pose.position).norm(), 1e-9) << "no velocity is known";
  EXPECT_GT(DeviationOfALostScan(&street, 101, &odometry), 1.4) << "it may drive 15 m/s";
  const Estimate earlier = odometry.OnScan(street.StartOf(2), kPeriod, street.Scan(2));
  EXPECT_TRUE(earlier.map_restarted);
}

TEST(OddScans, TakesAnyPoints) {
  Odometry odometry({});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const TimedPoints bad = {{{nan, 0, 0}, {inf, 1, 1}, {1e300, 1e300, 0}, {0, 0, 0}},
                           {0.0F, 2.0F, -1.0F, 0.5F},
                           {0, 65535, 1, 0}};
  for (int i = 0; i < 3; ++i) {
    const Estimate e = odometry.OnScan(Time{} + i * kPeriod, kPeriod, bad);
    EXPECT_TRUE(e.pose.position.allFinite());
    odometry.OnScan(Time{} + i * kPeriod + milliseconds(50), kPeriod, {});
  }
  EXPECT_TRUE(odometry.map().empty());
}

TEST(OddScans, TakesTenMillionPoints) {
  constexpr std::size_t kPoints = 10'000'000;
  TimedPoints room;
  room.points.reserve(kPoints);
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double along = 1e-3 * static_cast<double>(i % 20'000) - 10;
    const double across = 0.02 * static_cast<double>(i / 20'000) - 5;
    room.points.emplace_back(along, i % 3 == 0 ? 5 : across, i % 3 == 0 ? across : -2);
  }
  room.phases.assign(kPoints, 0.5F);
  Odometry odometry({});
  for (int i = 0; i < 2; ++i)
    EXPECT_TRUE(odometry.OnScan(Time{} + i * kPeriod, kPeriod, room).pose.position.norm() < 0.01);
  EXPECT_LT(odometry.map().voxels(), 2'000U);
}

TEST(OddScans, FollowsADriveOfWhichSomeScansAreThinnedOut) {
  Drive drive(synth::SceneKind::kStreet, 10);
  Odometry odometry({});
  Pose pose;
  for (std::uint64_t i = 0; i < 30; ++i) {
    const TimedPoints whole = drive.Scan(i);
    TimedPoints thinned;
    for (std::size_t n = 0; n < whole.points.size(); ++n) {
      // Keeps each beam, each 2nd beam or each 3rd beam.
      if (whole.rings[n] % (i / 5 % 3 + 1) != 0) continue;
      thinned.points.push_back(whole.points[n]);
      thinned.phases.push_back(whole.phases[n]);
      thinned.rings.push_back(whole.rings[n]);
    }
    pose = odometry.OnScan(drive.StartOf(i), kPeriod, thinned).pose;
  }
  const Pose way = drive.WayTo(29);
  EXPECT_LT((pose.position - way.position).norm(), 0.2);
}

TEST(OddScans, FollowsWhateverTheRateOfTheScans) {
  for (const std::uint64_t every : {2U, 3U}) {  // each 2nd or each 3rd of ten scans per second
    Drive drive(synth::SceneKind::kStreet, 8);
    Odometry odometry({});
    Pose pose;
    for (std::uint64_t i = 0; i < 30; i += every)
      pose = odometry.OnScan(drive.StartOf(i), kPeriod, drive.Scan(i)).pose;
    const std::uint64_t last = 29 / every * every;
    const Pose way = drive.WayTo(last);
    EXPECT_LT((pose.position - way.position).norm(), 0.9) << every;
  }
}

TEST(OddScans, BeginsAgainWhereScansComeInTheWrongOrder) {
  Drive drive(synth::SceneKind::kStreet, 10);
  Odometry odometry({});
  for (const std::uint64_t i : {0U, 1U, 2U, 3U, 2U, 3U, 4U, 5U}) {
    const Estimate e = odometry.OnScan(drive.StartOf(i), kPeriod, drive.Scan(i));
    EXPECT_TRUE(e.pose.position.allFinite());
    EXPECT_LT(e.pose.position.norm(), 10);
  }
}

TEST(OddScans, ReachesFartherAfterAGapInWhichTheCarBraked) {
  Drive drive(synth::SceneKind::kTown, 10);
  Odometry odometry({});
  for (std::uint64_t i = 0; i < 20; ++i) odometry.OnScan(drive.StartOf(i), kPeriod, drive.Scan(i));
  // In 0.5 s, the sensor moves only as far as it did in each 0.4 s before.
  const Pose found = odometry.OnScan(drive.StartOf(24), kPeriod, drive.Scan(23)).pose;
  const Pose way = drive.WayTo(23);
  EXPECT_LT((found.position - way.position).norm(), 0.6);
}

/// After a gap, the map shows little of the scene around the sensor, so fewer upright surfaces fit.
TEST(OddScans, TracksASceneThatAGapHasMadeNew) {
  Drive drive(synth::SceneKind::kField, 15, 4);
  Odometry odometry({});
  int lost = 0;
  Estimate e;
  for (std::uint64_t i = 0; i < 130; ++i) {
    if (i >= 100 && i < 115) continue;
    e = odometry.OnScan(drive.StartOf(i), kPeriod, drive.Scan(i));
    lost += e.tracking == Tracking::kLost ? 1 : 0;
  }
  EXPECT_EQ(lost, 0);
  EXPECT_LT((e.pose.position - drive.WayTo(129).position).norm(), 1.5);
}

}  // namespace
}  // namespace lidar::odometry
