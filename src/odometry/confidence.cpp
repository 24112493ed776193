// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/odometry/confidence.h"

#include <Eigen/LU>
#include <algorithm>

namespace lidar::odometry {
namespace {

/// Standard deviations for a vehicle: first those of a velocity that is not known, then those of
/// the acceleration. The first constant of each pair is for the translation [m/s, m/s^2], the
/// second for the rotation [rad/s, rad/s^2].
constexpr double kSpeed = 15;
constexpr double kTurn = 0.5;
constexpr double kAcceleration = 2;
constexpr double kTurnAcceleration = 1;
/// The errors of a gyroscope, including its noise and scale, expressed as an angular acceleration
/// [rad/s^2].
constexpr double kTurnDrift = 0.2;
/// The least variance of a pose [m^2, rad^2]. It avoids a division by zero if two scans have the
/// same time.
constexpr double kLeastVariance = 1e-8;

// Indices of the parts in the joint error.
constexpr Eigen::Index kMap = 0;
constexpr Eigen::Index kPose = 6;
constexpr Eigen::Index kVelocity = 12;

Twist Spread(double translation, double rotation) {
  Twist variances;
  variances << Eigen::Vector3d::Constant(translation * translation),
      Eigen::Vector3d::Constant(rotation * rotation);
  return variances;
}

}  // namespace

Matrix6 Adjoint(const Pose& pose) {
  Matrix6 adjoint = Matrix6::Zero();
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  adjoint.topLeftCorner<3, 3>() = adjoint.bottomRightCorner<3, 3>() = rotation;
  adjoint.topRightCorner<3, 3>() = Skew(pose.position) * rotation;
  return adjoint;
}

Confidence::Confidence() { ForgetVelocity(); }

Matrix6 Confidence::covariance() const {
  const Eigen::Matrix<double, 6, 18> both =
      joint_.middleRows<6>(kMap) + joint_.middleRows<6>(kPose);
  return both.middleCols<6>(kMap) + both.middleCols<6>(kPose);
}

void Confidence::ForgetVelocity() {
  EnterMap();
  joint_.middleRows<6>(kVelocity).setZero();
  joint_.middleCols<6>(kVelocity).setZero();
  joint_.diagonal().segment<6>(kVelocity) = Spread(kSpeed, kTurn);
}

void Confidence::SetVelocityKnown() {
  joint_.diagonal().segment<6>(kVelocity) = Spread(kAcceleration, kTurnAcceleration);
}

void Confidence::Predict(const Pose& motion, Duration gap, bool turn_measured) {
  const double t = Seconds(gap);
  Joint step = Joint::Identity();
  step.block<6, 6>(kMap, kMap) = step.block<6, 6>(kPose, kPose) = Adjoint(motion.Inverse());
  step.block<6, 6>(kPose, kVelocity) = t * Matrix6::Identity();
  // The state has the mean velocity since the last pose, so the acceleration is added before the
  // transition.
  joint_.diagonal().segment<6>(kVelocity) +=
      Spread(kAcceleration, turn_measured ? kTurnDrift : kTurnAcceleration) * (t * t);
  joint_ = step * joint_ * step.transpose();
}

Twist Confidence::Observe(const Matrix6& information, const Eigen::Matrix3d& unobserved,
                          const Twist& correction) {
  const Matrix6 told = information / kPointsOfOne;
  const Matrix6 pose = joint_.block<6, 6>(kPose, kPose);
  const Twist accelerated = joint_.block<6, 6>(kVelocity, kPose) * (PoseInformation() * correction);
  Eigen::Matrix<double, 18, 6> gain =
      joint_.middleCols<6>(kPose) * (Matrix6::Identity() + told * pose).inverse();
  // The gain is not optimal, because an alignment corrects only the observed directions of the
  // pose. So the covariance is updated in Joseph's form, which is valid for any gain.
  const Eigen::Matrix3d observed = Eigen::Matrix3d::Identity() - unobserved;
  gain.middleRows<6>(kMap).setZero();
  gain.middleRows<3>(kPose) = observed * gain.middleRows<3>(kPose).eval();
  gain.middleRows<3>(kVelocity) = observed * gain.middleRows<3>(kVelocity).eval();
  Joint left = Joint::Identity();
  left.middleCols<6>(kPose) -= gain * told;
  joint_ = left * joint_ * left.transpose() + gain * told * gain.transpose();
  joint_ = (joint_ + joint_.transpose().eval()) / 2;
  return accelerated;
}

Matrix6 Confidence::PoseInformation() const {
  const Matrix6 pose = joint_.block<6, 6>(kPose, kPose);
  return (pose + kLeastVariance * Matrix6::Identity()).inverse();
}

void Confidence::EnterMap() {
  Joint step = Joint::Identity();
  step.block<6, 6>(kMap, kPose).setIdentity();
  step.block<6, 6>(kPose, kPose).setZero();
  joint_ = step * joint_ * step.transpose();
}

}  // namespace lidar::odometry
