// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/odometry/pose.h"

#include <Eigen/LU>
#include <cmath>

namespace lidar::odometry {
namespace {

// The angle [rad] below which the first terms of the sine and cosine series are exact.
constexpr double kSmallAngle = 1e-6;

/// Returns the left Jacobian of SO(3), which converts a constant velocity of a rotating body to the
/// displacement of the body.
Eigen::Matrix3d LeftJacobian(const Eigen::Vector3d& rotation) {
  const double angle = rotation.norm();
  const Eigen::Matrix3d skew = Skew(rotation);
  if (angle < kSmallAngle) return Eigen::Matrix3d::Identity() + 0.5 * skew;
  const double square = angle * angle;
  return Eigen::Matrix3d::Identity() + (1 - std::cos(angle)) / square * skew +
         (angle - std::sin(angle)) / (square * angle) * skew * skew;
}

}  // namespace

Eigen::Matrix3d Skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Pose Exp(const Twist& twist) {
  const Eigen::Vector3d rotation = twist.tail<3>();
  const double angle = rotation.norm();
  Pose pose;
  if (angle > kSmallAngle) {
    pose.rotation = Eigen::AngleAxisd(angle, rotation / angle);
  } else {
    pose.rotation =
        Eigen::Quaterniond(1, rotation.x() / 2, rotation.y() / 2, rotation.z() / 2).normalized();
  }
  pose.position = LeftJacobian(rotation) * twist.head<3>();
  return pose;
}

Twist Log(const Pose& pose) {
  // A quaternion and its negative are the same rotation. The sign selects the shorter rotation.
  const double sign = pose.rotation.w() < 0 ? -1 : 1;
  const Eigen::Vector3d axis = sign * pose.rotation.vec();
  const double sine = axis.norm();
  const double angle = 2 * std::atan2(sine, sign * pose.rotation.w());
  Twist twist;
  twist.tail<3>() =
      sine > kSmallAngle ? Eigen::Vector3d(axis * (angle / sine)) : Eigen::Vector3d(2 * axis);
  twist.head<3>() = LeftJacobian(twist.tail<3>()).inverse() * pose.position;
  return twist;
}

double Angle(const Pose& pose) {
  return 2 * std::atan2(pose.rotation.vec().norm(), std::abs(pose.rotation.w()));
}

}  // namespace lidar::odometry
