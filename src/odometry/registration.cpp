// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/odometry/registration.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

namespace lidar::odometry {
namespace {

constexpr std::size_t kLeastPairs = 20;  // with fewer pairs no pose is computed
/// Weight of the prediction in a direction that the scene does not constrain. It exceeds the weight
/// of all points together.
constexpr double kHold = 1e6;
/// The least assumed error of a map [m], even if the residuals are smaller.
constexpr double kLeastSpread = 0.01;

/// The sums of one Gauss-Newton step. Its unknown is a motion of the sensor in the sensor's own
/// frame.
struct NormalEquations {
  Matrix6 lhs = Matrix6::Zero();
  Twist rhs = Twist::Zero();
  double weights = 0;
  double squares = 0;  // sum of the weighted squared residuals
  std::size_t pairs = 0;

  template <class Jacobian, class Residual>
  void Add(double weight, const Jacobian& jacobian, const Residual& residual) {
    lhs.noalias() += weight * jacobian.transpose() * jacobian;
    rhs.noalias() -= weight * jacobian.transpose() * residual;
    weights += weight;
    squares += weight * residual.squaredNorm();
    ++pairs;
  }
  void Add(double weight, const NormalEquations& other) {
    lhs += weight * other.lhs;
    rhs += weight * other.rhs;
    weights += weight * other.weights;
    squares += weight * other.squares;
    pairs += other.pairs;
  }
  /// Returns how the weight is distributed over the directions of a translation. The trace is 1 if
  /// all neighbours have a surface.
  Eigen::Matrix3d Constraint() const { return lhs.topLeftCorner<3, 3>() / weights; }
};

/// The sums over neighbours with a surface and over neighbours without one.
struct Neighbours {
  NormalEquations surfaces;
  NormalEquations points;
  std::size_t fitting = 0;
  /// The sums of n n' over the normals n: of all points that have a normal, and of the points that
  /// fit.
  Eigen::Matrix3d facing = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d fitting_facing = Eigen::Matrix3d::Zero();
};

Neighbours Linearise(const Surface& scan, LocalMap* map, const Pose& pose, double reach_m,
                     double kernel_m, const RegistrationSettings& settings) {
  Neighbours sums;
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  const double square = kernel_m * kernel_m;
  const auto weight_of = [square](double squared_residual) {
    const double scale = square / (square + squared_residual);
    return scale * scale;
  };
  Eigen::Matrix<double, 3, 6> jacobian;
  jacobian.leftCols<3>().setIdentity();
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Eigen::Vector3d& point = scan.points[i];
    const bool has_own = i < scan.normals.size();
    Eigen::Matrix3d own = Eigen::Matrix3d::Zero();
    if (has_own) own = scan.normals[i] * scan.normals[i].transpose();
    sums.facing += own;
    const Eigen::Vector3d there = rotation * point + pose.position;
    const auto nearest = map->FindNearest(there, reach_m);
    if (!nearest) continue;
    const Eigen::Vector3d residual = rotation.transpose() * (there - nearest->point);
    // The derivative of the residual is [I, -p^], in the sensor's frame.
    jacobian.rightCols<3>() = -Skew(point);
    bool fits = false;
    Eigen::Matrix3d faces = own;
    if (nearest->has_normal) {
      const Eigen::Vector3d normal = rotation.transpose() * nearest->normal;
      const Eigen::Matrix<double, 1, 1> distance(normal.dot(residual));
      fits = distance.norm() <= settings.fit_m;
      if (!has_own) sums.facing += faces = normal * normal.transpose();
      sums.surfaces.Add(weight_of(distance.squaredNorm()), normal.transpose() * jacobian, distance);
    } else {
      jacobian.rightCols<3>() *= settings.point_turn;
      fits = residual.norm() <= settings.fit_m;
      sums.points.Add(weight_of(residual.squaredNorm()), jacobian, residual);
    }
    if (!fits) continue;
    ++sums.fitting;
    sums.fitting_facing += faces;
  }
  return sums;
}

/// Returns the projection onto the directions that the scene does not constrain, in the sensor's
/// frame.
Eigen::Matrix3d FindUnobserved(const NormalEquations& sums, const RegistrationSettings& settings) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(sums.Constraint());
  const Eigen::Vector3d& held = solver.eigenvalues();  // in ascending order
  Eigen::Matrix3d unobserved = Eigen::Matrix3d::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const bool alone = i == 0 && held(0) < settings.least_balance * held(1);
    if (!alone && held(i) >= settings.least_constraint) continue;
    unobserved += solver.eigenvectors().col(i) * solver.eigenvectors().col(i).transpose();
  }
  return unobserved;
}

/// Returns true if surfaces constrain every direction. Then the prediction gets no weight, because
/// a car that turns always deviates from its predicted path.
bool AreEnough(const NormalEquations& surfaces, const RegistrationSettings& settings) {
  if (surfaces.pairs < kLeastPairs) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(surfaces.Constraint(),
                                                              Eigen::EigenvaluesOnly);
  return solver.eigenvalues()(0) >= settings.held_by_surfaces;
}

/// Returns the share of the `count` points that fit. Surfaces that face the best constrained
/// direction, such as the ground, are not counted.
double StandingShare(const Neighbours& found, std::size_t count) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(found.facing);
  const Eigen::Vector3d best = solver.eigenvectors().col(2);
  const auto lying = [&best](const Eigen::Matrix3d& sum) { return best.dot(sum * best); };
  const double all = static_cast<double>(count) - lying(found.facing);
  const double fitting = static_cast<double>(found.fitting) - lying(found.fitting_facing);
  return all > 0 ? fitting / all : 0;
}

/// Returns the variance of the residuals.
double VarianceOf(const NormalEquations& sums) {
  return std::max(sums.squares / sums.weights, kLeastSpread * kLeastSpread);
}

}  // namespace

Alignment Align(const Surface& scan, LocalMap* map, const Prediction& prediction, double reach_m,
                double kernel_m, const RegistrationSettings& settings) {
  const Pose& guess = prediction.pose;
  Alignment result;
  result.pose = guess;
  if (scan.points.empty() || map->empty()) return result;
  bool enough = false;
  while (result.iterations++ < settings.max_iterations) {
    const Neighbours found = Linearise(scan, map, result.pose, reach_m, kernel_m, settings);
    if (result.iterations == 1) enough = AreEnough(found.surfaces, settings);
    NormalEquations sums = found.surfaces;
    sums.Add(enough ? settings.spare_point_weight : settings.point_weight, found.points);
    result.inlier_share =
        static_cast<double>(found.fitting) / static_cast<double>(scan.points.size());
    result.standing_share = StandingShare(found, scan.points.size());
    if (sums.pairs < kLeastPairs) return {guess, result.inlier_share, 0, result.iterations};
    if (result.iterations == 1) {
      result.unobserved = FindUnobserved(sums, settings);
      result.degenerate = !result.unobserved.isZero();
    }
    const double variance = VarianceOf(sums);
    result.information = sums.lhs / variance;
    if (!enough) {
      const Matrix6 hold = variance * Confidence::kPointsOfOne * prediction.information;
      sums.lhs += hold;
      sums.rhs -= hold * Log(guess.Inverse() * result.pose);
    }
    sums.lhs.topLeftCorner<3, 3>() += kHold * sums.weights * result.unobserved;
    const Twist step = sums.lhs.ldlt().solve(sums.rhs);
    if (!step.allFinite()) return {guess, 0, 0, result.iterations};
    result.pose = result.pose * Exp(step);
    if (step.norm() < settings.converged) break;
  }
  return result;
}

}  // namespace lidar::odometry
