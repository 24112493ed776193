// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/odometry/pose.h"

#include <gtest/gtest.h>

namespace lidar::odometry {
namespace {

Twist MakeTwist(double x, double y, double z, double a, double b, double c) {
  Twist twist;
  twist << x, y, z, a, b, c;
  return twist;
}

class PoseLogarithms : public testing::TestWithParam<Twist> {};

TEST_P(PoseLogarithms, AreUndoneByTheExponential) {
  const Twist there_and_back = Log(Exp(GetParam()));
  EXPECT_LT((there_and_back - GetParam()).norm(), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Pose, PoseLogarithms,
                         testing::Values(MakeTwist(0, 0, 0, 0, 0, 0), MakeTwist(1, -2, 3, 0, 0, 0),
                                         MakeTwist(1, 2, 3, 1e-8, 0, 0),
                                         MakeTwist(1, 2, 3, 0.1, -0.2, 0.3),
                                         MakeTwist(-4, 0, 1, 0, 0, 3.1),
                                         MakeTwist(0, 5, 0, -2, 2, 0.5)));

TEST(Pose, DrivesAQuarterOfACircle) {
  // The motion is a quarter of a circle to the left, with a radius of 1 and at constant speed.
  const Pose pose = Exp(MakeTwist(M_PI / 2, 0, 0, 0, 0, M_PI / 2));
  EXPECT_LT((pose.position - Eigen::Vector3d(1, 1, 0)).norm(), 1e-12);
  EXPECT_NEAR(Angle(pose), M_PI / 2, 1e-12);
}

TEST(Pose, IsUndoneByItsInverse) {
  const Pose pose = Exp(MakeTwist(1, 2, 3, 0.4, 0.5, -0.6));
  const Pose none = pose * pose.Inverse();
  EXPECT_LT(none.position.norm(), 1e-12);
  EXPECT_LT(Angle(none), 1e-7);
}

TEST(Pose, TakesTheShorterWayRound) {
  Pose pose = Exp(MakeTwist(0, 0, 0, 0, 0, 0.2));
  pose.rotation.coeffs() *= -1;  // This is the same rotation.
  EXPECT_LT((Log(pose) - MakeTwist(0, 0, 0, 0, 0, 0.2)).norm(), 1e-12);
  EXPECT_NEAR(Angle(pose), 0.2, 1e-12);
}

TEST(Pose, BendsALongWayByATinyTurn) {
  const Pose pose = Exp(MakeTwist(1e6, 0, 0, 0, 0, 5e-7));
  EXPECT_NEAR(pose.position.y(), 0.25, 1e-6);
}

}  // namespace
}  // namespace lidar::odometry
