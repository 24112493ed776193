// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds beams that turn while they swing up and down: those of sensors whose scans do not repeat.
#pragma once
#include <optional>
#include <vector>

#include "src/codec/cloud/beam_keeper.h"
#include "src/codec/cloud/beam_table.h"

namespace lidar::codec::cloud {

/// Returns the path of `points`, which are in the order of firing, and places them on it. Returns
/// nothing if azimuths are not at even steps. The table `last`, or null, shortens the search.
std::optional<BeamTable> FindPath(const std::vector<Sighting>& points, const BeamTable* last,
                                  std::vector<PlacedPoint>* placed);

}  // namespace lidar::codec::cloud
