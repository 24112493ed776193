// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the steps between the points of a beam.
#pragma once
#include <cstdint>
#include <vector>

#include "src/codec/cloud/beam_table.h"

namespace lidar::codec::cloud {

/// The azimuth of a beam's point.
struct BeamAzimuth {
  std::int32_t azimuth;
  float rho_m;
};
/// The azimuths of a beam, in ascending order.
using BeamAzimuths = std::vector<BeamAzimuth>;

/// Finds the most common step of each beam, and counts the points of the beams that have the same
/// step. Returns the smallest step that has at least a tenth of all points, or 0 if there is none.
std::int32_t UsualStep(const std::vector<BeamAzimuths>& beams);
/// Returns the mean step. Only neighbouring points that are a few steps of about `usual` apart are
/// used. Returns 0 if there are none.
double MeanStep(const std::vector<BeamAzimuths>& beams, std::int32_t usual);
/// Returns the step near `step` with which columns fit the points best all around the turn. Steps
/// with a whole number of columns in a turn are preferred.
double AlignedStep(const std::vector<BeamAzimuths>& beams, double step);

/// Returns the number of columns in a turn, in 1/BeamTable::kParts.
inline std::uint32_t TurnOf(double step) {
  return static_cast<std::uint32_t>(std::lround(kTurn / step * BeamTable::kParts));
}

/// Returns the most common distance of a beam's azimuths from multiples of `step`, in steps.
double PhaseAt(const BeamAzimuths& azimuths, double step);
/// Returns the circular mean of the distances of a beam's azimuths from multiples of `step`, in
/// steps. It is used if azimuths scatter.
double MeanPhase(const BeamAzimuths& azimuths, double step);

struct Side {
  std::int32_t side_um = 0;
  double alignment = 0;  // from 0 to 1
};

/// Returns the distance at which a beam passes the origin, if its points lie at multiples of
/// `step`.
Side SideOf(const BeamAzimuths& azimuths, double step);
/// Returns the angle of which the azimuths are multiples. This is the step of the columns, or the
/// unit to which the sensor rounds azimuths.
double QuantumOf(const std::vector<BeamAzimuths>& beams, std::int32_t usual, double step);

}  // namespace lidar::codec::cloud
