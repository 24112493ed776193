// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the beams of a cloud. The points of a beam lie on a line in the plane of rho and z, where
// rho is the distance from the z axis.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/codec/cloud/beam_table.h"

namespace lidar::codec::cloud {

/// The line z = height_m + tangent * rho, where rho is the distance from the z axis.
struct BeamLine {
  double tangent = 0;
  double height_m = 0;

  /// Returns the distance of a point from the line. It is negative if the point is below the line.
  double Above(const Sighting& s) const {
    return (s.z_m - height_m - tangent * s.rho_m) / std::sqrt(1 + tangent * tangent);
  }
};

struct FoundBeam {
  BeamLine line;
  std::vector<std::uint32_t> points;  // indices of its points
};

struct FoundBeams {
  std::vector<FoundBeam> beams;  // top to bottom
  std::size_t points = 0;        // number of points on all beams
};

/// Finds beams that meet in the origin. The points of a beam have nearly the same elevation.
FoundBeams FindMeetingBeams(const std::vector<Sighting>& points);
/// Finds beams that pass the origin at a distance of up to 0.5 m.
FoundBeams FindPassingBeams(const std::vector<Sighting>& points);
/// Finds beams that meet in the origin and bend. They are peaks in the histogram of elevations.
FoundBeams FindBendingBeams(const std::vector<Sighting>& points);

}  // namespace lidar::codec::cloud
