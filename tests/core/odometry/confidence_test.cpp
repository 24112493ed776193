// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/odometry/confidence.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace lidar::odometry {
namespace {

using std::chrono::milliseconds;

constexpr Duration kPeriod = milliseconds(100);
const Eigen::Matrix3d kNothing = Eigen::Matrix3d::Zero();

Pose Ahead(double metres) { return {Eigen::Quaterniond::Identity(), {metres, 0, 0}}; }
double Variance(const Confidence& confidence, Eigen::Index axis) {
  return confidence.covariance()(axis, axis);
}

TEST(Confidence, IsFullAtTheStart) { EXPECT_TRUE(Confidence().covariance().isZero(0)); }

TEST(Confidence, IsThatOfTheScanWhileTheMapStays) {
  Confidence confidence;
  double first = 0;
  for (int i = 0; i < 50; ++i) {
    confidence.Predict({}, kPeriod);
    confidence.Observe(1e4 * Matrix6::Identity(), kNothing, Twist::Zero());
    if (i == 0) first = Variance(confidence, 0);
  }
  EXPECT_LE(Variance(confidence, 0), first);
}

TEST(Confidence, FallsWithEachScanThatEntersTheMap) {
  Confidence confidence;
  for (int i = 0; i < 20; ++i) {
    const double before = Variance(confidence, 1);
    confidence.Predict(Ahead(1), kPeriod);
    confidence.Observe(1e4 * Matrix6::Identity(), kNothing, Twist::Zero());
    confidence.EnterMap();
    EXPECT_GT(Variance(confidence, 1), before);
  }
}

TEST(Confidence, FallsWithTheWayAlongWhatIsNotSeen) {
  Eigen::Matrix3d along = Eigen::Matrix3d::Zero();
  along(0, 0) = 1;
  Confidence confidence;
  for (int i = 0; i < 20; ++i) {
    confidence.Predict(Ahead(1), kPeriod);
    confidence.Observe(1e6 * Matrix6::Identity(), along, Twist::Zero());
    confidence.EnterMap();
  }
  EXPECT_GT(std::sqrt(Variance(confidence, 0)), 20) << "two seconds at an unknown speed";
  EXPECT_LT(std::sqrt(Variance(confidence, 1)), 1);
}

TEST(Confidence, OfATurnFallsLessWhereAGyroscopeMeasuresIt) {
  const auto turn = [](bool measured) {
    Confidence confidence;
    for (int i = 0; i < 20; ++i) {
      confidence.Predict({}, kPeriod, measured);
      confidence.Observe(1e4 * Matrix6::Identity(), kNothing, Twist::Zero());
      if (i == 0) confidence.SetVelocityKnown();
    }
    for (int i = 0; i < 10; ++i) confidence.Predict({}, kPeriod, measured);
    return Variance(confidence, 5);
  };
  EXPECT_LT(turn(true), turn(false) / 2);
}

TEST(Confidence, FallsLessWhereTheVelocityIsKnown) {
  Confidence unknown;
  Confidence known;
  known.SetVelocityKnown();
  for (Confidence* confidence : {&unknown, &known}) confidence->Predict({}, kPeriod);
  EXPECT_LT(Variance(known, 0), Variance(unknown, 0) / 10);
}

/// Returns the confidence after a bend of `scans` scans that showed some directions better than
/// others.
Confidence AfterABend(int scans) {
  const Pose step{Eigen::Quaterniond(Eigen::AngleAxisd(0.1, Eigen::Vector3d(0.1, 0.2, 1))),
                  {1, 0.3, -0.1}};
  Eigen::Matrix3d along = Eigen::Matrix3d::Zero();
  along(0, 0) = 1;
  Matrix6 information = 1e4 * Matrix6::Identity();
  information(0, 4) = information(4, 0) = 3e3;
  Confidence confidence;
  for (int i = 0; i < scans; ++i) {
    confidence.Predict(step, kPeriod, i % 2 == 0);
    confidence.Observe(information, i % 3 == 0 ? along : kNothing, Twist::Constant(0.01));
    if (i % 4 == 0) confidence.EnterMap();
  }
  return confidence;
}

TEST(Confidence, OfAVelocityThatIsForgottenIsThatAtTheStart) {
  Confidence fresh;
  fresh.Predict({}, kPeriod);
  for (const int scans : {1, 2, 5, 9}) {
    Confidence confidence = AfterABend(scans);
    const Matrix6 before = confidence.covariance();
    confidence.ForgetVelocity();
    EXPECT_TRUE(confidence.covariance().isApprox(before, 1e-9)) << "the pose is where it was";
    confidence.Predict({}, kPeriod);
    EXPECT_TRUE((confidence.covariance() - before).isApprox(fresh.covariance(), 1e-9)) << scans;
  }
}

TEST(Confidence, IsTheSameInBothDirections) {
  for (const int scans : {1, 2, 5, 9}) {
    Confidence confidence = AfterABend(scans);
    const auto check = [&] {
      const Matrix6 covariance = confidence.covariance();
      EXPECT_LT((covariance - covariance.transpose()).norm(), 1e-9 * covariance.norm());
      const Matrix6 information = confidence.PoseInformation();
      EXPECT_LT((information - information.transpose()).norm(), 1e-6 * information.norm());
    };
    check();
    confidence.ForgetVelocity();
    check();
    confidence.Predict(Ahead(1), kPeriod);
    check();
    confidence.SetVelocityKnown();
    confidence.Predict(Ahead(1), kPeriod);
    check();
    confidence.EnterMap();
    check();
  }
}

TEST(Confidence, FallsWithoutScans) {
  Confidence confidence;
  confidence.Predict({}, kPeriod);
  confidence.Observe(1e4 * Matrix6::Identity(), kNothing, Twist::Zero());
  const double before = Variance(confidence, 0);
  confidence.Predict({}, 10 * kPeriod);
  EXPECT_GT(Variance(confidence, 0), 10 * before);
}

TEST(Confidence, GivesTheVelocityAllOfACorrectionWhereItIsNotKnownYet) {
  Confidence confidence;
  confidence.Predict({}, kPeriod);
  const Twist found = Twist::Unit(0) * 1.2;
  const Twist accelerated = confidence.Observe(1e6 * Matrix6::Identity(), kNothing, found);
  EXPECT_NEAR(accelerated(0), 12, 0.1);
  EXPECT_NEAR(accelerated.tail<5>().norm(), 0, 1e-9);
}

TEST(Confidence, GivesTheVelocityLessOfWhatScansSayWeakly) {
  Confidence confidence;
  Matrix6 weak = 1e6 * Matrix6::Identity();
  weak(0, 0) = 100;
  Twist accelerated;
  for (int i = 0; i < 50; ++i) {
    confidence.Predict({}, kPeriod);
    accelerated = confidence.Observe(weak, kNothing, Twist::Constant(0.01));
  }
  EXPECT_LT(accelerated(0), 0.5 * accelerated(1));
  EXPECT_LT(accelerated(1), 0.1 + 1e-6) << "a correction over its time, and no more";
}

TEST(Confidence, TakesTwoScansOfTheSameTime) {
  Confidence confidence;
  for (int i = 0; i < 3; ++i) {
    confidence.Predict({}, Duration{0});
    EXPECT_TRUE(confidence.PoseInformation().allFinite());
    const Twist accelerated =
        confidence.Observe(1e6 * Matrix6::Identity(), kNothing, Twist::Constant(1));
    EXPECT_TRUE(accelerated.allFinite());
    confidence.EnterMap();
  }
  EXPECT_TRUE(confidence.covariance().allFinite());
}

TEST(Confidence, KeepsWhatThePoseIsOffWhereAMapBegins) {
  Confidence confidence;
  confidence.Predict({}, kPeriod);
  confidence.Observe(1e4 * Matrix6::Identity(), kNothing, Twist::Zero());
  const Matrix6 before = confidence.covariance();
  confidence.ForgetVelocity();
  EXPECT_TRUE(confidence.covariance().isApprox(before));
}

}  // namespace
}  // namespace lidar::odometry
