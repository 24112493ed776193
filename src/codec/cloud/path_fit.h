// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the path of beams by the time of each point and the laser that measured it.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/codec/cloud/beam_keeper.h"
#include "src/codec/cloud/beam_table.h"

namespace lidar::codec::cloud {

/// Returns the path of `points`, which were measured at `pulses`, and places them on it. Returns
/// nothing if the lasers do not fire at even steps of time, or do not turn.
std::optional<BeamTable> FindPath(const std::vector<Sighting>& points,
                                  const std::vector<Pulse>& pulses,
                                  std::vector<PlacedPoint>* placed);

}  // namespace lidar::codec::cloud
