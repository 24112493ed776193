// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/slam/pose_graph.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

namespace lidar::slam {
namespace {

using odometry::Pose;

/// The difference between an edge and the poses that it joins, in standard deviations.
class Difference {
 public:
  explicit Difference(const Edge& edge) : edge_(edge) {}

  template <class T>
  bool operator()(const T* qa, const T* pa, const T* qb, const T* pb, T* residual) const {
    using Quaternion = Eigen::Quaternion<T>;
    using Vector = Eigen::Matrix<T, 3, 1>;
    const Eigen::Map<const Quaternion> rotation_a(qa);
    const Eigen::Map<const Quaternion> rotation_b(qb);
    const Quaternion back = rotation_a.conjugate();
    const Vector seen = back * (Eigen::Map<const Vector>(pb) - Eigen::Map<const Vector>(pa));
    const Quaternion turn =
        edge_.pose.rotation.conjugate().template cast<T>() * (back * rotation_b);
    Eigen::Map<Vector>{residual} =
        (seen - edge_.pose.position.template cast<T>()) / T(edge_.sigma_m);
    const T sign = turn.w() < T(0) ? T(-1) : T(1);
    Eigen::Map<Vector>{residual + 3} = sign * T(2) / T(edge_.sigma_rad) * turn.vec();
    return true;
  }

 private:
  Edge edge_;
};

}  // namespace

bool Optimise(const std::vector<Edge>& edges, std::vector<Pose>* poses) {
  constexpr int kMostIterations = 100;
  std::vector<Pose> moved = *poses;
  ceres::EigenQuaternionManifold rotations;
  ceres::Problem::Options options;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(options);
  for (const Edge& edge : edges) {
    if (edge.a >= moved.size() || edge.b >= moved.size() || edge.a == edge.b) return false;
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<Difference, 6, 4, 3, 4, 3>(new Difference(edge)), nullptr,
        moved[edge.a].rotation.coeffs().data(), moved[edge.a].position.data(),
        moved[edge.b].rotation.coeffs().data(), moved[edge.b].position.data());
  }
  for (Pose& pose : moved) {
    double* rotation = pose.rotation.coeffs().data();
    if (problem.HasParameterBlock(rotation)) problem.SetManifold(rotation, &rotations);
  }
  if (moved.empty() || !problem.HasParameterBlock(moved[0].position.data())) return false;
  problem.SetParameterBlockConstant(moved[0].rotation.coeffs().data());
  problem.SetParameterBlockConstant(moved[0].position.data());
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  solver.max_num_iterations = kMostIterations;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  if (!summary.IsSolutionUsable()) return false;
  *poses = std::move(moved);
  return true;
}

}  // namespace lidar::slam
