// SPDX-License-Identifier: LGPL-2.1-or-later
// The surfaces that a single scan shows: a normal for each point, from the beams around it.
#pragma once
#include <cstdint>
#include <vector>

#include "src/odometry/pose.h"

namespace lidar::odometry {

/// A map of points alone takes the circle that one beam draws on the ground for an edge, and the
/// circle moves with the sensor. The beams above and below tell that there is a plane.
class ScanNormals {
 public:
  /// `rings`: which beam each of `points` is of, in any order of the beams. Both are only read
  /// here. Points that are not finite have no normal, nor does any if there are no rings.
  ScanNormals(const Points& points, const std::vector<std::uint16_t>& rings);

  /// The normal has unit length and points to the sensor. It is zero where the neighbours of the
  /// point lie on no plane.
  Eigen::Vector3d At(const Eigen::Vector3d& point, std::uint16_t ring) const;

  static constexpr std::size_t kMaxRings = 1024;  // points of others are left out

 private:
  struct Ring {
    bool seen = false;
    double height = 0;  // sine of the elevation
    int above = -1;     // the next ring that is far enough for a baseline; -1: none
    int below = -1;
  };
  struct Side {
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();
    bool seen = false;
  };
  void FindNeighbours();
  void SumUp(const std::vector<Eigen::Vector3f>& image);
  Side MeanOf(int ring, int first_bin, int bins) const;
  bool FitPlane(const int (&rings)[3], int bin, const Eigen::Vector3f& point,
                Eigen::Vector3f* normal) const;

  std::vector<Ring> rings_;
  /// Ring by ring: the sum and, in the last number, the count of the returns before each bin.
  std::vector<Eigen::Vector4d> sums_;
};

}  // namespace lidar::odometry
