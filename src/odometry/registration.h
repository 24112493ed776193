// SPDX-License-Identifier: LGPL-2.1-or-later
// Robust ICP: finds the pose at which a scan fits the map.
#pragma once
#include "src/odometry/confidence.h"
#include "src/odometry/local_map.h"
#include "src/odometry/pose.h"

namespace lidar::odometry {

struct RegistrationSettings {
  int max_iterations = 100;
  double converged = 5e-4;  // length of the last step [m and rad]
  /// Weight of a neighbour without a surface if surfaces hold every direction. Neighbours with a
  /// surface have weight 1. A neighbour without a surface is seldom the same spot.
  double spare_point_weight = 1;
  /// Weight of a neighbour without a surface if surfaces leave a direction open.
  double point_weight = 1;
  /// Weight of the rotation in the pull of a neighbour without a surface: distant wrong neighbours
  /// would turn the sensor most.
  double point_turn = 1;
  /// Surfaces hold a direction if at least this share of them faces it: 0 to 1.
  double held_by_surfaces = 0.04;
  /// A direction is not observed if a smaller share of surfaces faces it.
  double least_constraint = 0.04;
  /// The direction with the least share is not observed, either, if its share is below this part of
  /// the second least, as along a tunnel.
  double least_balance = 0.3;
  /// Greatest distance of a fitting point from its surface or neighbour. It does not depend on the
  /// reach, so that a wide search does not make a scan fit.
  double fit_m = 0.2;
};

/// Points of a scan in the sensor's frame, with the normals that the scan shows.
struct Surface {
  Points points;
  Points normals;  // of the first points; the other points have no normal
};

/// The pose before the points are used.
struct Prediction {
  Pose pose;
  /// Information of the pose, as a motion of the sensor in its own frame.
  Matrix6 information = Matrix6::Zero();
};

struct Alignment {
  Pose pose;
  double inlier_share = 0;  // share of the points that fit
  /// The same share without the surfaces that face the best held direction: they are usually
  /// ground, which fits at every place. Normals come from the scan, or else from the map.
  double standing_share = 0;
  int iterations = 0;
  /// The scene does not show the motion along a direction; the guess is kept there.
  bool degenerate = false;
  /// Projection on the unobserved directions, in the sensor's frame.
  Eigen::Matrix3d unobserved = Eigen::Matrix3d::Zero();
  /// Information of a motion of the sensor in its own frame, if the points' errors are independent.
  Matrix6 information = Matrix6::Zero();
};

/// Aligns the points of `scan` to `map`, from `guess`, as KISS-ICP does (Vizzo et al.,
/// 2023, section III-D): neighbours within `reach_m`, residuals weighted by the Geman-McClure
/// kernel of scale `kernel_m`. Unlike KISS-ICP, a surface of the map counts by the distance from
/// the surface: a wall does not hold motion along it, and fewer iterations suffice. The prediction
/// holds the pose along directions that the points hold weakly.
Alignment Align(const Surface& scan, LocalMap* map, const Prediction& prediction, double reach_m,
                double kernel_m, const RegistrationSettings& settings);
/// Aligns from a guess without a known error.
inline Alignment Align(const Points& points, LocalMap* map, const Pose& guess, double reach_m,
                       double kernel_m, const RegistrationSettings& settings) {
  return Align({points, {}}, map, Prediction{guess, Matrix6::Zero()}, reach_m, kernel_m, settings);
}

}  // namespace lidar::odometry
