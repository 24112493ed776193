// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the columns of beams whose points are not at equal steps.
#pragma once
#include <vector>

#include "src/codec/cloud/column_step.h"

namespace lidar::codec::cloud {

/// Shifts the offset of each beam so that its points lie in the middle of their columns.
void Recentre(const std::vector<BeamAzimuths>& beams, BeamTable* table);
/// Gives the columns a list of places, if this saves more bits than the list costs.
void FindPlaces(const std::vector<BeamAzimuths>& beams, double step, BeamTable* table);
/// Finds places for a sensor that rounds azimuths to multiples of `quantum`, which is about as
/// large as a step. The firings of all beams have the same places, but each beam has its own delay.
/// Returns false if the points of different beams do not agree.
bool FindRoundedPlaces(const std::vector<BeamAzimuths>& beams, double quantum, double step,
                       BeamTable* table);
/// Finds the swings of beams whose steps are uneven in a periodic way.
void FindSwings(const std::vector<BeamAzimuths>& beams, BeamTable* table);

/// An azimuth minus the offset of its beam.
struct StraightAzimuth {
  std::int32_t azimuth;
  std::uint32_t beam;
};
/// Adapts the columns of `table` to the next cloud. Returns false if too few or too many columns
/// are found.
bool UpdateColumns(const std::vector<StraightAzimuth>& azimuths, BeamTable* table);

// Parts of the functions above:

/// Returns `places`, with places added for the firings without points.
std::vector<std::uint32_t> WithGapsFilled(const std::vector<std::uint32_t>& places, double step,
                                          std::uint32_t grains);
/// Sets the delays so that column 0 of each beam is the first column at or after azimuth 0.
void AlignDelays(BeamTable* table);
/// Rotates the swings so that they fit the firings of the next cloud.
void TurnSwings(const std::vector<StraightAzimuth>& azimuths, BeamTable* table);

}  // namespace lidar::codec::cloud
