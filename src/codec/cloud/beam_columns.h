// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the columns of a cloud: the azimuths at which its beams see points.
#pragma once
#include <optional>
#include <vector>

#include "src/codec/cloud/beam_table.h"

namespace lidar::codec::cloud {

/// Returns nothing if most points lie on no beam, or in no columns.
std::optional<BeamTable> FindBeams(const std::vector<Sighting>& points);

}  // namespace lidar::codec::cloud
