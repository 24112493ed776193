// SPDX-License-Identifier: LGPL-2.1-or-later
// Keeps the beams of a stream's clouds: finding them takes long, seeing that they fit does not.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/codec/cloud/beam_table.h"

namespace lidar::codec::cloud {

/// A point and the pixel of its beam and column.
struct PlacedPoint {
  double along_m = 0;         // of the beam
  double above_m = 0;         // how far the point is above it
  std::int32_t azimuth = 0;   // without what the beam's side adds, less its offset
  std::int32_t residual = 0;  // how far that is from the column's
  std::int32_t bend = 0;      // where beams bend, how far its elevation is above the beam's
  std::uint32_t beam = 0;
  std::uint32_t column = 0;
};

class BeamKeeper {
 public:
  /// An image has no more pixels, and a search would take seconds.
  static constexpr std::size_t kMostPoints = 1U << 20;

  /// Places the points of a cloud in the beams of the clouds before if they fit, else in those that
  /// it finds. Returns null where it finds none. It looks for others less and less often while none
  /// fit.
  const BeamTable* Place(const std::vector<Sighting>& points, std::vector<PlacedPoint>* placed);

 private:
  bool PlaceByOld(const std::vector<Sighting>& points, std::vector<PlacedPoint>* placed);

  bool PlaceOnNewPath(const std::vector<Sighting>& points, const BeamTable* last,
                      std::vector<PlacedPoint>* placed);

  std::optional<BeamTable> table_;
  double fit_ = 0;      // part of the points that are near their pixels
  unsigned fails_ = 0;  // clouds in a row that did not fit
};

}  // namespace lidar::codec::cloud
