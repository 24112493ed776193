// SPDX-License-Identifier: LGPL-2.1-or-later
// Density maps of places, seen from above, and the pose between two places.
#pragma once
#include <Eigen/Core>
#include <optional>

#include "src/odometry/pose.h"

namespace lidar::slam {

/// The density map of KISS-SLAM (Guadagnino et al., 2025): the number of points above ground in
/// each square metre. Flat ground counts 0, seen or not.
class Place {
 public:
  /// `points` are relative to the middle of the place, with z nearly up. Points beyond kRadius are
  /// left out.
  explicit Place(const odometry::Points& points);

  static constexpr double kRadius = 64;  // [m]
  static constexpr int kCells = 128;     // number of cells along each side, a metre each
  using Density = Eigen::Array<std::complex<float>, Eigen::Dynamic, Eigen::Dynamic>;
  const Density& spectrum() const { return spectrum_; }
  double energy() const { return energy_; }
  const odometry::Points& standing() const { return standing_; }
  const odometry::Points& ground() const { return ground_; }

  /// Returns the height of the lowest point near (x, y), or NaN.
  float LowestAt(double x, double y) const;

 private:
  Density spectrum_;
  double energy_ = 0;          // sum of the squares of the map
  odometry::Points standing_;  // points above ground
  odometry::Points ground_;    // lowest points
  Eigen::ArrayXXf lowest_;
};

struct PlaceMatch {
  odometry::Pose pose;  // of `b` in the frame of `a`
  double score = 0;     // overlap of both maps, 0 to 1
  /// Score relative to the best score elsewhere. Streets look alike along their length.
  double distinct = 0;
};

/// Finds where the map of `b`, turned by `yaw` plus or minus `yaw_range` [rad], fits that of `a`
/// best. Then raises and tilts the map of `b` so that the grounds of both meet. Returns nothing if
/// they share no ground.
std::optional<PlaceMatch> Match(const Place& a, const Place& b, double yaw, double yaw_range);

}  // namespace lidar::slam
