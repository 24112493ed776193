// SPDX-License-Identifier: LGPL-2.1-or-later
// Keeps the beams of a stream from cloud to cloud, because a check takes less time than a search.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/codec/cloud/beam_table.h"

namespace lidar::codec::cloud {

/// A point and the pixel of its beam and column.
struct PlacedPoint {
  double along_m = 0;         // distance along the beam
  double above_m = 0;         // height of the point above it; 0 if beams bend
  std::int32_t azimuth = 0;   // without the angle that the beam's side adds
  std::int32_t residual = 0;  // distance from the column's azimuth
  std::int32_t bend = 0;      // elevation above the beam's, if beams bend or are on a path
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
  /// Larger clouds exceed the pixels of an image, and a search in them takes seconds.
  static constexpr std::size_t kMostPoints = 1U << 20;

  /// Places `points` on the beams of earlier clouds. If they do not fit, it finds new beams in
  /// `all`, the points of the cloud to which `points` belong; after many failures, only in some
  /// clouds. Returns null if there are no beams. `pulses` has one pulse for each of `points`; if it
  /// is empty, no beams on a path are found.
  const BeamTable* Place(const std::vector<Sighting>& points, const std::vector<Pulse>& pulses,
                         const std::vector<Point>& all, std::vector<PlacedPoint>* placed);
  /// The beams of the last cloud, or null.
  const BeamTable* table() const { return table_ ? &*table_ : nullptr; }

 private:
  bool PlaceByOld(const std::vector<Sighting>& points, const std::vector<Pulse>& pulses,
                  std::vector<PlacedPoint>* placed);

  bool PlaceOnNewPath(const std::vector<Sighting>& points, const std::vector<Pulse>& pulses,
                      std::vector<PlacedPoint>* placed);

  std::optional<BeamTable> table_;
  double fit_ = 0;      // part of the points near their pixels
  unsigned fails_ = 0;  // clouds in a row that did not fit
};

}  // namespace lidar::codec::cloud
