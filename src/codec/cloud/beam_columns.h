// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the columns of a cloud: the azimuths at which its beams have points.
#pragma once
#include <optional>
#include <vector>

#include "src/codec/cloud/beam_table.h"

namespace lidar::codec::cloud {

/// Finds the beams and columns of a cloud. Returns nothing if too few points are on beams, or if
/// the points of a beam are not in columns.
std::optional<BeamTable> FindBeams(const std::vector<Sighting>& points);

}  // namespace lidar::codec::cloud
