// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the steps at which the beams of a cloud see points.
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
/// The azimuths of a beam, rising.
using BeamAzimuths = std::vector<BeamAzimuth>;

/// Each beam has a most common step. Returns the smallest of these steps whose beams together have
/// a tenth of all points; 0: there is none.
std::int32_t UsualStep(const std::vector<BeamAzimuths>& beams);
/// Returns the mean step, from neighbouring points that are one or a few steps of about `usual`
/// apart; 0: there are none.
double MeanStep(const std::vector<BeamAzimuths>& beams, std::int32_t usual);
/// Returns the step near `step` whose columns fit best all around the turn. A whole number of
/// columns is preferred.
double AlignedStep(const std::vector<BeamAzimuths>& beams, double step);

/// Columns of a turn in 1/BeamTable::kParts.
inline std::uint32_t TurnOf(double step) {
  return static_cast<std::uint32_t>(std::lround(kTurn / step * BeamTable::kParts));
}

/// Returns the most common distance of a beam's azimuths from multiples of `step`, in steps.
double PhaseAt(const BeamAzimuths& azimuths, double step);
/// Returns the circular mean of these distances, for azimuths that scatter.
double MeanPhase(const BeamAzimuths& azimuths, double step);

struct Side {
  std::int32_t side_um = 0;
  double alignment = 0;  // from 0 to 1
};

/// Returns the distance at which the beam passes the origin, if its points lie at multiples of
/// `step`.
Side SideOf(const BeamAzimuths& azimuths, double step);
/// Returns the angle of which the azimuths are multiples: the step of the columns, or of the
/// sensor's rounding.
double QuantumOf(const std::vector<BeamAzimuths>& beams, std::int32_t usual, double step);

}  // namespace lidar::codec::cloud
