// SPDX-License-Identifier: LGPL-2.1-or-later
// Rigid motions, SE(3), and their logarithms.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

namespace lidar::odometry {

using Points = std::vector<Eigen::Vector3d>;  // [m]

/// A translation [m], then a rotation vector [rad].
using Twist = Eigen::Matrix<double, 6, 1>;

/// Maps points of a body's frame to the frame in which the body is seen.
struct Pose {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // [m]

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return rotation * point + position;
  }
  Pose operator*(const Pose& other) const {
    return {(rotation * other.rotation).normalized(), *this * other.position};
  }
  Pose Inverse() const {
    const Eigen::Quaterniond back = rotation.conjugate();
    return {back, -(back * position)};
  }
};

/// A moving sensor.
struct Moving {
  Pose pose;
  Twist velocity = Twist::Zero();  // per second, in the sensor's frame
};

/// The motion at constant velocity for one unit of time; Sola et al., "A micro Lie theory", (172).
Pose Exp(const Twist& twist);
/// Inverse of Exp(), for rotations below half a turn.
Twist Log(const Pose& pose);
/// Angle of the rotation [rad], 0 to pi.
double Angle(const Pose& pose);
/// Returns the matrix with Skew(v) * w = v x w.
Eigen::Matrix3d Skew(const Eigen::Vector3d& v);

}  // namespace lidar::odometry
