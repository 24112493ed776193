// SPDX-License-Identifier: LGPL-2.1-or-later
// Estimates the error of a pose with a Kalman filter of the errors of pose and velocity.
#pragma once
#include "src/base/time.h"
#include "src/odometry/pose.h"

namespace lidar::odometry {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// The covariance of the estimation errors, which are twists in the sensor's frame. Each scan is
/// aligned to the map, so errors accumulate only over the scans that are added to the map.
class Confidence {
 public:
  Confidence();

  /// Makes the velocity unknown. The error of the pose does not change.
  void ForgetVelocity();
  void SetVelocityKnown();
  /// Predicts the error after the motion `motion`. If `turn_measured` is true, a gyroscope has
  /// measured the rotation of this motion.
  void Predict(const Pose& motion, Duration gap, bool turn_measured = false);
  /// Updates the error after an alignment. `information` is the information of the aligned pose,
  /// computed as if the errors of points were independent. `unobserved` is the projection onto the
  /// directions in which the pose was not corrected. `correction` is the motion from the predicted
  /// pose to the aligned pose. Returns the change of the velocity.
  Twist Observe(const Matrix6& information, const Eigen::Matrix3d& unobserved,
                const Twist& correction);
  /// Notes that the scan at the current pose was added to the map.
  void EnterMap();

  /// Returns the information of the pose relative to the map.
  Matrix6 PoseInformation() const;
  /// The number of points that give as much information as one independent point. The errors of
  /// neighbouring points depend on each other.
  static constexpr double kPointsOfOne = 12;
  /// Returns the covariance of the pose relative to the first scan, in the sensor's frame.
  Matrix6 covariance() const;

 private:
  /// The covariance of three errors of six numbers each: the error of the map at the sensor, the
  /// error of the pose relative to the map, and the error of the velocity.
  using Joint = Eigen::Matrix<double, 18, 18>;

  Joint joint_ = Joint::Zero();
};

/// Returns the adjoint matrix of `pose`, which transforms a twist from the frame of the body to the
/// outer frame.
Matrix6 Adjoint(const Pose& pose);

}  // namespace lidar::odometry
