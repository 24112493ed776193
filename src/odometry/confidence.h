// SPDX-License-Identifier: LGPL-2.1-or-later
// Estimates how far a pose may be off, by a Kalman filter of the errors of pose and velocity.
#pragma once
#include "src/base/time.h"
#include "src/odometry/pose.h"

namespace lidar::odometry {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Errors are twists in the sensor's frame. Each scan is aligned to the map, so
/// errors add up only over the scans that enter the map.
class Confidence {
 public:
  Confidence();

  /// Makes the velocity unknown, and keeps the error of the pose.
  void ForgetVelocity();
  void SetVelocityKnown();
  /// Moves the sensor by `motion`, which the velocity predicts; with `turn_measured` a gyroscope
  /// measured its rotation.
  void Predict(const Pose& motion, Duration gap, bool turn_measured = false);
  /// Takes an alignment. `information` is that of the pose if the errors of its points are
  /// independent. `unobserved` projects onto the directions in which the prediction is not
  /// corrected. `correction` leads from the predicted pose to the found one. Returns the change of
  /// the velocity.
  Twist Observe(const Matrix6& information, const Eigen::Matrix3d& unobserved,
                const Twist& correction);
  /// Begins to map from the present pose.
  void EnterMap();

  /// Information of the pose relative to the map.
  Matrix6 PoseInformation() const;
  /// Errors of neighbouring points depend on each other: this number of points gives as much
  /// information as one independent point.
  static constexpr double kPointsOfOne = 12;
  /// Covariance of the pose since the first scan, in the sensor's frame.
  Matrix6 covariance() const;

 private:
  /// The errors of the map here, of the pose relative to the map, and of the velocity: six numbers
  /// each.
  using Joint = Eigen::Matrix<double, 18, 18>;

  Joint joint_ = Joint::Zero();
};

/// Returns the matrix that carries an error across a motion of the sensor.
Matrix6 Adjoint(const Pose& pose);

}  // namespace lidar::odometry
