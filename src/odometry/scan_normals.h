// SPDX-License-Identifier: LGPL-2.1-or-later
// Computes the normals that a single scan shows, from the beams around each point.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/odometry/pose.h"

namespace lidar::odometry {

/// A beam meets the ground in a circle, which moves with the sensor. In a map of points alone the
/// circle is an edge that holds the pose back. The beams above and below show that it lies on a
/// plane.
class ScanNormals {
 public:
  /// `rings` has the beam of each point, in any order of the beams. Only the constructor reads
  /// `points` and `rings`. Points that are not finite have no normal; without rings no point has
  /// one.
  ScanNormals(const Points& points, const std::vector<std::uint16_t>& rings);

  struct Surface {
    Eigen::Vector3d point;
    /// Has unit length and points to the sensor. It is zero if the point's neighbours lie on no
    /// plane.
    Eigen::Vector3d normal;
  };
  /// Moves a point along its normal to the mean of its ring nearby. Returns of grass lie on the
  /// cone of their beam, the nearest ones highest; a map of unmoved returns would be low at its
  /// front edge.
  Surface At(const Eigen::Vector3d& point, std::uint16_t ring) const;

  static constexpr std::size_t kMaxRings = 1024;  // points of further rings are left out

 private:
  struct Ring {
    bool seen = false;
    double height = 0;  // sine of the elevation
    int above = -1;     // next ring above with enough baseline; -1: none
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
  /// Per ring and bin: the sum of the returns before the bin, and in the last number their count.
  std::vector<Eigen::Vector4d> sums_;
};

}  // namespace lidar::odometry
