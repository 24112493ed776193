// SPDX-License-Identifier: LGPL-2.1-or-later
// Keeps the beams of a stream from one cloud to the next. A check whether they still fit takes less
// time than a search for beams.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/codec/cloud/beam_table.h"

namespace lidar::codec::cloud {

/// A point, its pixel (beam and column), and its distances from the middle of this pixel.
struct PlacedPoint {
  double along_m = 0;         // distance along the beam
  double above_m = 0;         // height of the point above the beam; 0 if beams bend
  std::int32_t azimuth = 0;   // azimuth of the point, minus SideAngle()
  std::int32_t residual = 0;  // distance from the column's azimuth
  std::int32_t bend = 0;      // elevation minus the beam's, if beams bend or are on a path
  std::uint32_t beam = 0;
  std::uint32_t column = 0;
};

/// When a point was measured, and by which laser.
struct Pulse {
  std::uint32_t line = 0;
  double time = 0;  // in any unit
};

class BeamKeeper {
 public:
  /// The largest number of points. A larger cloud would have more points than an image may have
  /// pixels, and a search for its beams would take seconds.
  static constexpr std::size_t kMostPoints = 1U << 20;

  /// Places `points` on the beams of earlier clouds. If they do not fit, finds new beams in `all`,
  /// which are all points of the cloud to which `points` belong. After many failures, it searches
  /// only in some clouds. Returns the beams, or null if there are none.
  ///
  /// `pulses` has one pulse for each of `points`, or is empty. If it is empty, no beams on a path
  /// are found.
  const BeamTable* Place(const std::vector<Sighting>& points, const std::vector<Pulse>& pulses,
                         const std::vector<Point>& all, std::vector<PlacedPoint>* placed);
  /// Returns the beams of the last cloud, or null.
  const BeamTable* table() const { return table_ ? &*table_ : nullptr; }

 private:
  bool PlaceByOld(const std::vector<Sighting>& points, const std::vector<Pulse>& pulses,
                  std::vector<PlacedPoint>* placed);

  bool PlaceOnNewPath(const std::vector<Sighting>& points, const std::vector<Pulse>& pulses,
                      std::vector<PlacedPoint>* placed);

  std::optional<BeamTable> table_;
  double fit_ = 0;      // part of the points near their pixels, when the beams were found
  unsigned fails_ = 0;  // consecutive clouds that did not fit
};

}  // namespace lidar::codec::cloud
