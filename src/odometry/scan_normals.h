// SPDX-License-Identifier: LGPL-2.1-or-later
// Computes surface normals from a single scan, with the beams above and below each point.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/odometry/pose.h"

namespace lidar::odometry {

/// Finds the normals of a scan. A beam meets the ground in a circle, which moves with the sensor.
/// In a map that has only points, this circle looks like an edge and holds the pose back. With the
/// beams above and below, the circle is recognised as a part of a plane.
class ScanNormals {
 public:
  /// `rings` has the beam number of each point. Beams may be numbered in any order. `points` and
  /// `rings` are used in the constructor only. Points that are not finite have no normal. If
  /// `rings` is empty, no point has a normal.
  ScanNormals(const Points& points, const std::vector<std::uint16_t>& rings);

  struct Surface {
    Eigen::Vector3d point;
    /// A unit vector that points towards the sensor. It is zero if the returns around the point do
    /// not lie on a plane.
    Eigen::Vector3d normal;
  };
  /// Returns the normal at a point, and the point moved along this normal to the mean of the
  /// returns around it in its ring. Returns of grass lie on the cone of their beam, and the nearest
  /// of them are the highest. If they were not moved, a map of them would be too low at its front
  /// edge.
  Surface At(const Eigen::Vector3d& point, std::uint16_t ring) const;

  static constexpr std::size_t kMaxRings = 1024;  // points of further rings are ignored

 private:
  struct Ring {
    bool seen = false;
    double height = 0;  // sine of the elevation
    int above = -1;     // next ring above with enough distance; -1: none
    int below = -1;
  };
  struct Side {
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();
    bool seen = false;
  };
  void FindNeighbours();
  void SumUp(const std::vector<Eigen::Vector3f>& image);
  Side MeanOf(int ring, int first_bin, int bins) const;
  std::optional<Eigen::Vector3f> FitPlane(const int (&rings)[3], int bin,
                                          const Eigen::Vector3f& point) const;

  std::vector<Ring> rings_;
  /// Partial sums for each ring and bin: the sum of all returns before the bin, and their number as
  /// the last component.
  std::vector<Eigen::Vector4d> sums_;
};

}  // namespace lidar::odometry
