// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the pose at which a scan fits the map, by robust ICP.
#pragma once
#include "src/odometry/confidence.h"
#include "src/odometry/local_map.h"
#include "src/odometry/pose.h"

namespace lidar::odometry {

struct RegistrationSettings {
  int max_iterations = 100;
  double converged = 5e-4;  // stop after a step that is shorter than this [m and rad]
  /// Weight of neighbours without a surface, if surfaces constrain every direction. Neighbours with
  /// a surface have the weight 1. A neighbour without a surface is seldom the same spot as the
  /// point.
  double spare_point_weight = 1;
  /// Weight of neighbours without a surface, if surfaces do not constrain every direction.
  double point_weight = 1;
  /// Factor by which neighbours without a surface affect the rotation. It may be less than 1,
  /// because wrong neighbours far away would rotate the sensor most.
  double point_turn = 1;
  /// Surfaces constrain a direction if at least this share of them faces the direction: 0 to 1.
  double held_by_surfaces = 0.04;
  /// A direction is not observed if a smaller share of the surfaces faces it.
  double least_constraint = 0.04;
  /// The direction that the smallest share of surfaces faces is also not observed if this share is
  /// less than this fraction of the second smallest. Along a tunnel, for example, it is not
  /// observed.
  double least_balance = 0.3;
  /// The greatest distance at which a point fits its surface or its neighbour. It does not depend
  /// on the search distance, because a wide search must not make a scan fit.
  double fit_m = 0.2;
};

/// Points of a scan in the sensor's frame, with the normals that were found in the scan.
struct Surface {
  Points points;
  Points normals;  // normals of the first points; all further points have none
};

/// The predicted pose, before the scan is aligned.
struct Prediction {
  Pose pose;
  /// The information of the pose, for a motion of the sensor in its own frame.
  Matrix6 information = Matrix6::Zero();
};

struct Alignment {
  Pose pose;
  double inlier_share = 0;  // share of the points that fit
  /// The share of the points that fit, without surfaces that face the best constrained direction.
  /// These surfaces are usually ground, which fits at any place. Normals come from the scan, or
  /// else from the map.
  double standing_share = 0;
  int iterations = 0;
  /// True if the scene does not constrain the motion in a direction. There the predicted pose is
  /// kept.
  bool degenerate = false;
  /// The projection onto the directions that are not observed, in the sensor's frame.
  Eigen::Matrix3d unobserved = Eigen::Matrix3d::Zero();
  /// The information of the pose, for a motion of the sensor in its own frame. It is computed as if
  /// the errors of the points were independent.
  Matrix6 information = Matrix6::Zero();
};

/// Aligns the points of `scan` to `map`, starting at the predicted pose, as in KISS-ICP (Vizzo et
/// al., 2023, section III-D). Neighbours are searched within `reach_m`, and residuals are weighted
/// by a Geman-McClure kernel of scale `kernel_m`. Unlike in KISS-ICP, the residual of a neighbour
/// with a surface is the distance from this surface. So a wall does not constrain the motion along
/// the wall, and fewer iterations are needed. The prediction holds the pose in directions that the
/// points hardly constrain.
Alignment Align(const Surface& scan, LocalMap* map, const Prediction& prediction, double reach_m,
                double kernel_m, const RegistrationSettings& settings);
/// Aligns points to the map. The error of `guess` is not known.
inline Alignment Align(const Points& points, LocalMap* map, const Pose& guess, double reach_m,
                       double kernel_m, const RegistrationSettings& settings) {
  return Align({points, {}}, map, Prediction{guess, Matrix6::Zero()}, reach_m, kernel_m, settings);
}

}  // namespace lidar::odometry
