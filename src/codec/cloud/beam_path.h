// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds beams that turn on and on while they swing up and down: those of sensors whose scans do not
// repeat.
#pragma once
#include <optional>
#include <vector>

#include "src/codec/cloud/beam_keeper.h"
#include "src/codec/cloud/beam_table.h"

namespace lidar::codec::cloud {

/// Returns the path of `points` that are in the order of firing, beams in turn, and places them on
/// it; nothing where azimuths are not at even steps. The search is short where they swing as often
/// as in the table `last`, which may be null.
std::optional<BeamTable> FindPath(const std::vector<Sighting>& points, const BeamTable* last,
                                  std::vector<PlacedPoint>* placed);

}  // namespace lidar::codec::cloud
