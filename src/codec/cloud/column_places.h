// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the columns of beams that do not see points at even steps.
#pragma once
#include <vector>

#include "src/codec/cloud/column_step.h"

namespace lidar::codec::cloud {

/// Shifts the offset of each beam so that its points lie in the middle of their columns.
void Recentre(const std::vector<BeamAzimuths>& beams, BeamTable* table);
/// Gives the columns places of their own if this saves more bits than it costs.
void FindPlaces(const std::vector<BeamAzimuths>& beams, double step, BeamTable* table);
/// Finds places for azimuths that a sensor rounds to multiples of `quantum`, which is about as
/// large as a step. All beams see the same multiples, each with a delay. Returns false if the beams
/// do not agree.
bool FindRoundedPlaces(const std::vector<BeamAzimuths>& beams, double quantum, double step,
                       BeamTable* table);
/// Finds beams whose steps are uneven in a periodic way.
void FindSwings(const std::vector<BeamAzimuths>& beams, BeamTable* table);

/// An azimuth less the offset of its beam.
struct StraightAzimuth {
  std::int32_t azimuth;
  std::uint32_t beam;
};
/// Moves the columns to those of the next cloud. Returns false if too few or too many are found.
bool UpdateColumns(const std::vector<StraightAzimuth>& azimuths, BeamTable* table);

// Parts of the functions above:

/// Adds places for the firings without points.
std::vector<std::uint32_t> WithGapsFilled(const std::vector<std::uint32_t>& places, double step,
                                          std::uint32_t grains);
/// Sets the delays so that column 0 of each beam is the first one from azimuth 0 on.
void AlignDelays(BeamTable* table);
/// Rotates the swings so that they fit the firings of the next cloud.
void TurnSwings(const std::vector<StraightAzimuth>& azimuths, BeamTable* table);

}  // namespace lidar::codec::cloud
