// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/odometry/trajectory_error.h"

#include <algorithm>
#include <cmath>

namespace lidar::odometry {
namespace {

constexpr double kDegrees = 57.29577951308232;
constexpr Duration kRpeSpan = std::chrono::seconds(1);
constexpr double kShortestStretch = 100;  // [m]
constexpr double kLongestStretch = 800;

struct Pairs {
  Trajectory truth;
  Trajectory estimate;  // has the same length and times as `truth`
};

Pairs Match(const Trajectory& truth, const Trajectory& estimate) {
  Pairs pairs;
  if (truth.empty()) return pairs;
  for (const StampedPose& e : estimate) {
    if (e.time < truth.front().time || e.time > truth.back().time) continue;
    pairs.estimate.push_back(e);
    pairs.truth.push_back({e.time, InterpolateAt(truth, e.time)});
  }
  return pairs;
}

void MeasureAte(const Pairs& pairs, TrajectoryError* error) {
  const auto count = static_cast<Eigen::Index>(pairs.truth.size());
  Eigen::Matrix3Xd truth(3, count);
  Eigen::Matrix3Xd estimate(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    truth.col(i) = pairs.truth[static_cast<std::size_t>(i)].pose.position;
    estimate.col(i) = pairs.estimate[static_cast<std::size_t>(i)].pose.position;
  }
  const Eigen::Matrix4d align = Eigen::umeyama(estimate, truth, false);
  const Eigen::Matrix3Xd off =
      truth - ((align.topLeftCorner<3, 3>() * estimate).colwise() + align.topRightCorner<3, 1>());
  error->ate_rmse_m = std::sqrt(off.colwise().squaredNorm().mean());
  error->ate_max_m = std::sqrt(off.colwise().squaredNorm().maxCoeff());
}

/// Returns the error in the estimated motion from pose i to pose j.
Pose MotionError(const Pairs& pairs, std::size_t i, std::size_t j) {
  const Pose was = pairs.truth[i].pose.Inverse() * pairs.truth[j].pose;
  const Pose seen = pairs.estimate[i].pose.Inverse() * pairs.estimate[j].pose;
  return was.Inverse() * seen;
}

void MeasureRpe(const Pairs& pairs, TrajectoryError* error) {
  double metres = 0;
  double degrees = 0;
  std::size_t count = 0;
  for (std::size_t i = 0, j = 0; i < pairs.truth.size(); ++i) {
    while (j < pairs.truth.size() && pairs.truth[j].time < pairs.truth[i].time + kRpeSpan) ++j;
    if (j == pairs.truth.size()) break;
    const Pose off = MotionError(pairs, i, j);
    metres += off.position.squaredNorm();
    degrees += std::pow(Angle(off) * kDegrees, 2);
    ++count;
  }
  if (count == 0) return;
  error->rpe_rmse_m = std::sqrt(metres / static_cast<double>(count));
  error->rpe_rmse_deg = std::sqrt(degrees / static_cast<double>(count));
}

void MeasureDrift(const Pairs& pairs, TrajectoryError* error) {
  std::vector<double> way(1, 0.0);
  for (std::size_t i = 1; i < pairs.truth.size(); ++i)
    way.push_back(way.back() +
                  (pairs.truth[i].pose.position - pairs.truth[i - 1].pose.position).norm());
  error->length_m = way.back();
  double sum = 0;
  std::size_t count = 0;
  for (double stretch = kShortestStretch; stretch <= kLongestStretch; stretch += kShortestStretch) {
    for (std::size_t i = 0; i < way.size(); i += 10) {
      const auto end = std::lower_bound(way.begin(), way.end(), way[i] + stretch);
      if (end == way.end()) break;
      const auto j = static_cast<std::size_t>(end - way.begin());
      sum += MotionError(pairs, i, j).position.norm() / stretch;
      ++count;
    }
  }
  if (count > 0) error->drift = sum / static_cast<double>(count);
}

/// Returns the error of the last position, after the first second of both trajectories has been
/// aligned. A single pose is not enough, because a small error of its direction is a large error at
/// the end of a long path.
double EndError(const Pairs& pairs) {
  Eigen::Vector4d rotation = Eigen::Vector4d::Zero();
  Eigen::Vector3d truth = Eigen::Vector3d::Zero();
  Eigen::Vector3d estimate = Eigen::Vector3d::Zero();
  double count = 0;
  const Time until = pairs.truth.front().time + kRpeSpan;
  for (std::size_t i = 0; i < pairs.truth.size() && pairs.truth[i].time < until; ++i) {
    const Eigen::Quaterniond turn =
        pairs.truth[i].pose.rotation * pairs.estimate[i].pose.rotation.conjugate();
    rotation += turn.coeffs().dot(rotation) < 0 ? -turn.coeffs() : turn.coeffs();
    truth += pairs.truth[i].pose.position;
    estimate += pairs.estimate[i].pose.position;
    ++count;
  }
  const Eigen::Quaterniond turn(rotation.normalized());
  const Eigen::Vector3d end =
      turn * (pairs.estimate.back().pose.position - estimate / count) + truth / count;
  return (end - pairs.truth.back().pose.position).norm();
}

}  // namespace

std::optional<TrajectoryError> Compare(const Trajectory& truth, const Trajectory& estimate) {
  const Pairs pairs = Match(truth, estimate);
  if (pairs.truth.size() < 3) return std::nullopt;
  TrajectoryError error;
  error.poses = pairs.truth.size();
  MeasureAte(pairs, &error);
  MeasureRpe(pairs, &error);
  MeasureDrift(pairs, &error);
  error.end_error_m = EndError(pairs);
  return error;
}

}  // namespace lidar::odometry
