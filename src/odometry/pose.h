// SPDX-License-Identifier: LGPL-2.1-or-later
// Rigid motions in 3D, the group SE(3), and their logarithms.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

namespace lidar::odometry {

using Points = std::vector<Eigen::Vector3d>;  // [m]

/// A translation [m] and a rotation vector [rad], in this order.
using Twist = Eigen::Matrix<double, 6, 1>;

/// The pose of a body in an outer frame. It converts points from the frame of the body to the outer
/// frame.
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

/// The state of a moving sensor.
struct Moving {
  Pose pose;
  Twist velocity = Twist::Zero();  // per second, in the sensor's frame
};

/// Returns the motion during one unit of time at the constant velocity `twist`; Sola et al., "A
/// micro Lie theory", (172).
Pose Exp(const Twist& twist);
/// Returns the inverse of Exp(), for rotations of less than half a turn.
Twist Log(const Pose& pose);
/// Returns the angle of the rotation [rad], from 0 to pi.
double Angle(const Pose& pose);
/// Returns the matrix M for which M * w is the cross product v x w.
Eigen::Matrix3d Skew(const Eigen::Vector3d& v);

}  // namespace lidar::odometry
