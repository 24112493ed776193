// SPDX-License-Identifier: LGPL-2.1-or-later
// How far a pose may be off: a Kalman filter of the errors of pose and velocity.
#pragma once
#include "src/base/time.h"
#include "src/odometry/pose.h"

namespace lidar::odometry {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Errors are twists in the sensor's frame. A scan is aligned to the map, so its own error does not
/// add up; that of a scan which enters the map does.
class Confidence {
 public:
  Confidence();

  /// The velocity is not known; what the pose is off stays.
  void ForgetVelocity();
  void SetVelocityKnown();
  /// The sensor went on by `motion` as its velocity has it, or a gyroscope the turn of it.
  void Predict(const Pose& motion, Duration gap, bool turn_measured = false);
  /// A scan was aligned. `information`: what it says of the pose if errors of its points are
  /// independent. `unobserved`: the projection on the directions along which the prediction stays.
  /// `correction`: from the predicted pose to the one found. Returns what it makes of the velocity.
  Twist Observe(const Matrix6& information, const Eigen::Matrix3d& unobserved,
                const Twist& correction);
  /// The map grows from the present pose on.
  void EnterMap();

  /// Of the pose against the map.
  Matrix6 PoseInformation() const;
  /// Points next to each other see the same bump: so many say as much as one whose error is
  /// independent of the others'.
  static constexpr double kPointsOfOne = 12;
  /// Of the pose since the first one, in the sensor's frame.
  Matrix6 covariance() const;

 private:
  /// The map here, the pose against the map, the velocity: six numbers each.
  using Joint = Eigen::Matrix<double, 18, 18>;

  Joint joint_ = Joint::Zero();
};

/// What a motion of the sensor makes of an error before it.
Matrix6 Adjoint(const Pose& pose);

}  // namespace lidar::odometry
