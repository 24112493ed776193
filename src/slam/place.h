// SPDX-License-Identifier: LGPL-2.1-or-later
// Density maps of places from above, and the pose between two of them.
#pragma once
#include <Eigen/Core>
#include <optional>

#include "src/odometry/pose.h"

namespace lidar::slam {

/// The density map of KISS-SLAM (Guadagnino et al., 2025): how much stands on each square metre.
/// Flat ground counts 0, so it does not matter whether it was seen.
class Place {
 public:
  /// `points` around the middle of the place, z up but for a slope; what is farther than kRadius is
  /// left out.
  explicit Place(const odometry::Points& points);

  static constexpr double kRadius = 64;  // [m]
  static constexpr int kCells = 128;     // along each side of the map, a metre each
  using Density = Eigen::Array<std::complex<float>, Eigen::Dynamic, Eigen::Dynamic>;
  const Density& spectrum() const { return spectrum_; }
  double energy() const { return energy_; }
  const odometry::Points& standing() const { return standing_; }
  const odometry::Points& ground() const { return ground_; }

  /// The lowest point near (x, y), or NaN.
  float LowestAt(double x, double y) const;

 private:
  Density spectrum_;
  double energy_ = 0;          // the sum of the squares of the map
  odometry::Points standing_;  // the points above ground
  odometry::Points ground_;    // the lowest points
  Eigen::ArrayXXf lowest_;
};

struct PlaceMatch {
  odometry::Pose pose;  // of `b`, seen from `a`
  double score = 0;     // 0 to 1: how much of both maps lies over each other
  /// The score as a multiple of the best one elsewhere: streets look alike along their length.
  double distinct = 0;
};

/// Lays the map of `b` over that of `a` at the best place, turned by `yaw` give or take `yaw_range`
/// [rad]. Then tilts it so that their ground meets. Returns nothing if they share no ground.
std::optional<PlaceMatch> Match(const Place& a, const Place& b, double yaw, double yaw_range);

}  // namespace lidar::slam
