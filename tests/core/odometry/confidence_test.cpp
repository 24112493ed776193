// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/odometry/confidence.h"

#include <gtest/gtest.h>

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

TEST(Confidence, FallsWithoutScans) {
  Confidence confidence;
  confidence.Predict({}, kPeriod);
  confidence.Observe(1e4 * Matrix6::Identity(), kNothing, Twist::Zero());
  const double before = Variance(confidence, 0);
  confidence.Predict({}, 10 * kPeriod);
  EXPECT_GT(Variance(confidence, 0), 10 * before);
}

TEST(Confidence, FallsWherePredictionsAreOff) {
  const auto after = [](double off) {
    Confidence confidence;
    for (int i = 0; i < 100; ++i) {
      confidence.Predict({}, kPeriod);
      confidence.Observe(1e4 * Matrix6::Identity(), kNothing, Twist::Constant(off));
    }
    return Variance(confidence, 0);
  };
  EXPECT_GT(after(1), 10 * after(0.01));
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
