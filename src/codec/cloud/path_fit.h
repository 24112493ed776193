// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the path of beams. It needs the time of each point, and the laser that measured the point.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/codec/cloud/beam_keeper.h"
#include "src/codec/cloud/beam_table.h"

namespace lidar::codec::cloud {

/// Finds the path of `points`, and places the points on it. `pulses` has the time and the laser of
/// each point. Returns nothing if the lasers do not fire at equal intervals, or do not turn.
std::optional<BeamTable> FindPath(const std::vector<Sighting>& points,
                                  const std::vector<Pulse>& pulses,
                                  std::vector<PlacedPoint>* placed);

}  // namespace lidar::codec::cloud
