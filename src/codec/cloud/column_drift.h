// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds columns whose step changes slowly with the azimuth. Sensors with oscillating mirrors have
// such columns.
#pragma once
#include <vector>

#include "src/codec/cloud/beam_table.h"
#include "src/codec/cloud/column_step.h"

namespace lidar::codec::cloud {

/// Sets the places of all columns and the offsets of all beams. Returns false if there are too many
/// columns.
bool FindDriftingPlaces(const std::vector<BeamAzimuths>& beams, double step, BeamTable* table);

}  // namespace lidar::codec::cloud
