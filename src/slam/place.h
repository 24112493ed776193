// SPDX-License-Identifier: LGPL-2.1-or-later
// Maps of the density of points in a place, as seen from above, and the pose between two of them.
#pragma once
#include <Eigen/Core>
#include <optional>

#include "src/odometry/pose.h"

namespace lidar::slam {

/// The density map of KISS-SLAM (Guadagnino et al., 2025). It has the number of points above the
/// ground for each square metre. A cell without these points is 0, even if its ground was seen.
class Place {
 public:
  /// `points` are relative to the middle of the place, and z points almost upwards. Points beyond
  /// kRadius are ignored.
  explicit Place(const odometry::Points& points);

  static constexpr double kRadius = 64;  // in metres
  static constexpr int kCells = 128;     // number of cells along each side; a cell is a metre wide
  using Density = Eigen::Array<std::complex<float>, Eigen::Dynamic, Eigen::Dynamic>;
  const Density& spectrum() const { return spectrum_; }
  double energy() const { return energy_; }
  const odometry::Points& standing() const { return standing_; }
  const odometry::Points& ground() const { return ground_; }

  /// Returns the height of the lowest point in the cell of (x, y), or NaN if the cell has no point.
  float LowestAt(double x, double y) const;

 private:
  Density spectrum_;
  double energy_ = 0;          // sum of the squared counts
  odometry::Points standing_;  // points above the ground
  odometry::Points ground_;    // the lowest point of each cell
  Eigen::ArrayXXf lowest_;
};

struct PlaceMatch {
  odometry::Pose pose;  // pose of `b` in the frame of `a`
  double score = 0;     // overlap of the two maps, from 0 to 1
  /// The score divided by the best score at another position. It is low in streets, because they
  /// look alike along their length.
  double distinct = 0;
};

/// Finds the position at which the map of `b` matches the map of `a` best. The map of `b` is
/// rotated by `yaw` plus or minus `yaw_range` [rad]. Then raises and tilts the map of `b` until the
/// grounds of both maps coincide. Returns nothing if the maps have no common ground.
std::optional<PlaceMatch> Match(const Place& a, const Place& b, double yaw, double yaw_range);

}  // namespace lidar::slam
