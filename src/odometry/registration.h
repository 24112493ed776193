// SPDX-License-Identifier: LGPL-2.1-or-later
// Robust ICP: the pose from which the map explains a scan.
#pragma once
#include "src/odometry/confidence.h"
#include "src/odometry/local_map.h"
#include "src/odometry/pose.h"

namespace lidar::odometry {

struct RegistrationSettings {
  int max_iterations = 100;
  double converged = 5e-4;  // length of the last step [m and rad]
  /// A neighbour without a surface is seldom the same spot. What it counts against one with: where
  /// the surfaces hold every direction,
  double spare_point_weight = 1;
  /// and where they leave one open.
  double point_weight = 1;
  /// How much of its pull turns the sensor: far off, a wrong spot turns it most.
  double point_turn = 1;
  /// Surfaces hold a direction that they hold by that much (0: not at all, 1: all face it).
  double held_by_surfaces = 0.04;
  /// A direction that the surfaces hold less than this (0: not at all, 1: all face it) is not
  /// observed,
  double least_constraint = 0.04;
  /// nor is one that they hold less than this part of the next one: the length of a tunnel.
  double least_balance = 0.3;
  /// A point fits that lies so near to its surface, or to its neighbour. It does not grow with the
  /// reach, so a wide search does not make a scan fit.
  double fit_m = 0.2;
};

/// What is known of the pose before the points are looked at.
struct Prediction {
  Pose pose;
  /// Of its error, a motion of the sensor in its own frame.
  Matrix6 information = Matrix6::Zero();
};

struct Alignment {
  Pose pose;
  double inlier_share = 0;  // part of the points that fit
  /// The same of what tells places apart: all but the surfaces that face the direction which is
  /// held most, as ground does. Ground fits everywhere.
  double standing_share = 0;
  int iterations = 0;
  /// The scene does not show the motion along some direction; the guess is kept there.
  bool degenerate = false;
  /// The projection on those directions, in the sensor's frame.
  Eigen::Matrix3d unobserved = Eigen::Matrix3d::Zero();
  /// Of a motion of the sensor in its own frame, if the errors of the points are independent.
  Matrix6 information = Matrix6::Zero();
};

/// Aligns `points` of the sensor's frame to `map`, from `guess`, as KISS-ICP does (Vizzo et al.,
/// 2023, section III-D): neighbours within `reach_m`, residuals weighted by the Geman-McClure
/// kernel of scale `kernel_m`. It differs where the map has a surface: there the distance from the
/// surface counts, so that a wall does not hold a motion along it, and a step takes fewer
/// iterations. Along what the points hold weakly, the prediction holds the pose.
Alignment Align(const Points& points, LocalMap* map, const Prediction& prediction, double reach_m,
                double kernel_m, const RegistrationSettings& settings);
/// The same where only a pose to begin with is known.
inline Alignment Align(const Points& points, LocalMap* map, const Pose& guess, double reach_m,
                       double kernel_m, const RegistrationSettings& settings) {
  return Align(points, map, Prediction{guess, Matrix6::Zero()}, reach_m, kernel_m, settings);
}

}  // namespace lidar::odometry
