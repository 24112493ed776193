// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/slam/pose_graph.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>

#include "src/odometry/confidence.h"

namespace lidar::slam {
namespace {

using odometry::Matrix6;
using odometry::Pose;
using odometry::Twist;

constexpr int kMostIterations = 50;
constexpr double kConverged = 1e-9;  // stop if a step decreases the cost by a smaller fraction
constexpr double kLeastDamping = 1e-9;
constexpr double kMostDamping = 1e6;

Twist WeightsOf(const Edge& edge) {
  Twist weights;
  weights.head<3>().setConstant(1 / (edge.sigma_m * edge.sigma_m));
  weights.tail<3>().setConstant(1 / (edge.sigma_rad * edge.sigma_rad));
  return weights;
}

Twist ErrorOf(const Edge& edge, const std::vector<Pose>& poses) {
  return odometry::Log(edge.pose.Inverse() * (poses[edge.a].Inverse() * poses[edge.b]));
}

double CostOf(const std::vector<Edge>& edges, const std::vector<Pose>& poses) {
  double cost = 0;
  for (const Edge& edge : edges) {
    const Twist error = ErrorOf(edge, poses);
    cost += error.dot(WeightsOf(edge).cwiseProduct(error));
  }
  return cost;
}

/// The normal equations for all edges. The unknowns are motions of the poses in their own frames.
/// The first pose is fixed.
struct Equations {
  Eigen::SparseMatrix<double> lhs;
  Eigen::VectorXd rhs;

  Equations(const std::vector<Edge>& edges, const std::vector<Pose>& poses) {
    const auto size = static_cast<Eigen::Index>(6 * (poses.size() - 1));
    std::vector<Eigen::Triplet<double>> entries;
    rhs = Eigen::VectorXd::Zero(size);
    for (const Edge& edge : edges) {
      const Twist error = ErrorOf(edge, poses);
      const Twist weights = WeightsOf(edge);
      // See Sola et al., (65) and (66). The Jacobian is an approximation for small errors.
      const std::array<Matrix6, 2> jacobians = {
          -odometry::Adjoint(poses[edge.b].Inverse() * poses[edge.a]), Matrix6::Identity()};
      const std::array<std::size_t, 2> ends = {edge.a, edge.b};
      for (std::size_t i = 0; i < 2; ++i) {
        if (ends[i] == 0) continue;
        const Matrix6 weighted = jacobians[i].transpose() * weights.asDiagonal();
        rhs.segment<6>(RowOf(ends[i])) -= weighted * error;
        for (std::size_t j = 0; j < 2; ++j)
          if (ends[j] != 0) Add(RowOf(ends[i]), RowOf(ends[j]), weighted * jacobians[j], &entries);
      }
    }
    lhs.resize(size, size);
    lhs.setFromTriplets(entries.begin(), entries.end());
  }

 private:
  static Eigen::Index RowOf(std::size_t pose) { return static_cast<Eigen::Index>(6 * (pose - 1)); }
  static void Add(Eigen::Index row, Eigen::Index column, const Matrix6& block,
                  std::vector<Eigen::Triplet<double>>* entries) {
    for (Eigen::Index i = 0; i < 6; ++i)
      for (Eigen::Index j = 0; j < 6; ++j)
        entries->emplace_back(static_cast<int>(row + i), static_cast<int>(column + j), block(i, j));
  }
};

std::vector<Pose> Moved(const std::vector<Pose>& poses, const Eigen::VectorXd& step) {
  std::vector<Pose> moved = poses;
  for (std::size_t i = 1; i < moved.size(); ++i)
    moved[i] = moved[i] * odometry::Exp(step.segment<6>(static_cast<Eigen::Index>(6 * (i - 1))));
  return moved;
}

bool AreJoined(const std::vector<Edge>& edges, std::size_t poses) {
  return !edges.empty() && std::all_of(edges.begin(), edges.end(), [poses](const Edge& e) {
    return e.a < poses && e.b < poses && e.a != e.b;
  });
}

}  // namespace

bool Optimise(const std::vector<Edge>& edges, std::vector<Pose>* poses) {
  if (!AreJoined(edges, poses->size())) return false;
  double cost = CostOf(edges, *poses);
  double damping = kLeastDamping;
  for (int i = 0; i < kMostIterations && damping < kMostDamping; ++i) {
    Equations equations(edges, *poses);
    for (Eigen::Index k = 0; k < equations.rhs.size(); ++k)
      equations.lhs.coeffRef(k, k) *= 1 + damping;
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(equations.lhs);
    if (solver.info() != Eigen::Success) return false;
    std::vector<Pose> moved = Moved(*poses, solver.solve(equations.rhs));
    const double moved_cost = CostOf(edges, moved);
    if (!(moved_cost < cost)) {
      damping *= 100;
      continue;
    }
    const bool done = cost - moved_cost < kConverged * cost;
    *poses = std::move(moved);
    cost = moved_cost;
    damping = std::max(damping / 10, kLeastDamping);
    if (done) break;
  }
  return true;
}

}  // namespace lidar::slam
