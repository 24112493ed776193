// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the columns of beams that do not see points at even steps.
#pragma once
#include <vector>

#include "src/codec/cloud/column_step.h"

namespace lidar::codec::cloud {

/// Moves each beam so that it is in the middle of its columns.
void Recentre(const std::vector<BeamAzimuths>& beams, BeamTable* table);
/// Gives the columns places of their own where that saves more than it takes.
void FindPlaces(const std::vector<BeamAzimuths>& beams, double step, BeamTable* table);
/// The same for beams whose azimuths a sensor rounds to multiples of an angle, which is about as
/// large as a step: all see the same multiples, each later or earlier. False where they do not.
bool FindRoundedPlaces(const std::vector<BeamAzimuths>& beams, double quantum, double step,
                       BeamTable* table);
/// Finds beams that see points at uneven steps, again and again.
void FindSwings(const std::vector<BeamAzimuths>& beams, BeamTable* table);

/// An azimuth less the offset of its beam.
struct StraightAzimuth {
  std::int32_t azimuth;
  std::uint32_t beam;
};
/// Moves the columns to where those of the next cloud are. False where they cannot be found so.
bool UpdateColumns(const std::vector<StraightAzimuth>& azimuths, BeamTable* table);

}  // namespace lidar::codec::cloud
