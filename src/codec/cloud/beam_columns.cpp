// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/beam_columns.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

#include "src/codec/cloud/beam_lines.h"
#include "src/codec/cloud/beam_locator.h"
#include "src/codec/cloud/column_drift.h"
#include "src/codec/cloud/column_places.h"
#include "src/codec/cloud/column_step.h"

namespace lidar::codec::cloud {
namespace {

constexpr double kCovered = 0.6;  // part of all points that must be on beams

std::vector<BeamAzimuths> AzimuthsOf(const std::vector<Sighting>& points, const FoundBeams& found) {
  std::vector<BeamAzimuths> all;
  for (const FoundBeam& beam : found.beams) {
    BeamAzimuths& azimuths = all.emplace_back();
    for (const std::uint32_t i : beam.points)
      azimuths.push_back({points[i].azimuth, static_cast<float>(points[i].rho_m)});
    std::sort(azimuths.begin(), azimuths.end(),
              [](const BeamAzimuth& a, const BeamAzimuth& b) { return a.azimuth < b.azimuth; });
  }
  return all;
}

/// Subtracts the angle that is added to the azimuths of a beam if it does not pass through the
/// origin.
void StraightenBeam(const BeamTable::Beam& beam, BeamAzimuths* azimuths) {
  for (BeamAzimuth& a : *azimuths) {
    const double angle = SideAngle(beam, static_cast<double>(a.rho_m));
    a.azimuth = (a.azimuth - static_cast<std::int32_t>(std::lround(angle))) & (kTurn - 1);
  }
}

/// Rounds a length to a multiple of the unit that lengths have in a table.
std::int32_t InLengthUnits(double um) {
  constexpr std::int32_t kUnit = BeamTable::kLengthUnitUm;
  return kUnit * static_cast<std::int32_t>(std::lround(um / kUnit));
}

/// Finds the reach of each beam: the position of range 0 along the beam. Beams have different
/// reaches. A reach can only be found up to a multiple of the unit in which the sensor measures
/// ranges.
void FindReaches(const std::vector<Sighting>& points, const FoundBeams& found, BeamTable* table) {
  constexpr double kClear = 0.8;  // 1 is the best value
  const BeamLocator locator(*table);
  for (const double unit_mm : {8.0, 5.0, 4.0, 2.0, 1.0}) {
    std::vector<std::complex<double>> phases(table->rows());
    double aligned = 0;
    for (std::uint32_t b = 0; b < table->rows(); ++b) {
      for (const std::uint32_t i : found.beams[b].points)
        phases[b] += std::polar(1.0, 2e3 * M_PI * locator.On(b, points[i]).along_m / unit_mm);
      aligned += std::abs(phases[b]);
    }
    if (aligned < kClear * static_cast<double>(found.points)) continue;
    for (std::uint32_t b = 0; b < table->rows(); ++b) {
      const double reach_um = 1e3 * unit_mm * std::arg(phases[b]) / (2 * M_PI);
      table->beams[b].reach_um = InLengthUnits(reach_um);
    }
    return;
  }
}

std::optional<BeamTable> FindColumns(const FoundBeams& found, bool passing,
                                     std::vector<BeamAzimuths> azimuths) {
  const std::int32_t usual = UsualStep(azimuths);
  if (usual == 0) return std::nullopt;
  double step = MeanStep(azimuths, usual);
  if (step <= 0) return std::nullopt;
  BeamTable table;
  table.turn = TurnOf(step);
  const double quantum = passing ? QuantumOf(azimuths, usual, step) : step;
  for (std::size_t i = 0; i < found.beams.size(); ++i) {
    const BeamLine& line = found.beams[i].line;
    BeamTable::Beam beam;
    beam.elevation = static_cast<std::int32_t>(std::lround(std::atan(line.tangent) / kRadians));
    if (passing) {
      beam.height_um = InLengthUnits(1e6 * line.height_m);
      beam.side_um = SideOf(azimuths[i], quantum).side_um;
      StraightenBeam(beam, &azimuths[i]);
    }
    table.beams.push_back(beam);
  }
  const bool is_exact = quantum > 0.8 * step;
  if (!is_exact && FindRoundedPlaces(azimuths, quantum, step, &table)) {
    Recentre(azimuths, &table);
    return table;
  }
  table.turn = TurnOf(AlignedStep(azimuths, step));
  if (table.columns() == 0 || table.columns() > BeamTable::kMostColumns) return std::nullopt;
  step = static_cast<double>(kTurn) * BeamTable::kParts / table.turn;
  for (std::size_t i = 0; i < found.beams.size(); ++i) {
    const double phase = is_exact ? PhaseAt(azimuths[i], step) : MeanPhase(azimuths[i], step);
    table.beams[i].offset = static_cast<std::int32_t>(std::lround(phase * step)) & (kTurn - 1);
  }
  FindPlaces(azimuths, step, &table);
  FindSwings(azimuths, &table);
  return table;
}

std::optional<BeamTable> FindBentColumns(const FoundBeams& found,
                                         const std::vector<BeamAzimuths>& azimuths) {
  constexpr std::int32_t kUnit = BeamTable::kBentElevation;
  const std::int32_t usual = UsualStep(azimuths);
  const double step = usual == 0 ? 0 : MeanStep(azimuths, usual);
  if (step <= 0) return std::nullopt;
  BeamTable table;
  table.bends = true;
  for (const FoundBeam& f : found.beams) {
    BeamTable::Beam beam;
    const double elevation = std::atan(f.line.tangent) / kRadians;
    beam.elevation = kUnit * static_cast<std::int32_t>(std::lround(elevation / kUnit));
    table.beams.push_back(beam);
  }
  if (!FindDriftingPlaces(azimuths, step, &table)) return std::nullopt;
  return table;
}

/// Rounds elevations and offsets. Digits that the points do not determine would cost bits.
void RoundAngles(BeamTable* table) {
  constexpr std::int32_t kUnit = 8;
  const auto rounded = [](std::int32_t angle) { return (angle + kUnit / 2) & ~(kUnit - 1); };
  for (BeamTable::Beam& beam : table->beams) {
    beam.elevation = rounded(beam.elevation);
    beam.offset = rounded(beam.offset) & (kTurn - 1);
  }
}

std::optional<BeamTable> FindExactBeams(const std::vector<Sighting>& points) {
  const auto good = [&](const FoundBeams& found, double part) {
    return !found.beams.empty() && found.beams.size() <= BeamTable::kMostBeams &&
           static_cast<double>(found.points) >= part * static_cast<double>(points.size());
  };
  constexpr double kClearly = 0.9;
  const FoundBeams meeting = FindMeetingBeams(points);
  // If elevations are rounded, one bending beam looks like several beams.
  const FoundBeams bending = FindBendingBeams(points);
  if (good(bending, kClearly) && 2 * bending.beams.size() < meeting.beams.size())
    return FindBentColumns(bending, AzimuthsOf(points, bending));
  if (good(meeting, kClearly)) return FindColumns(meeting, false, AzimuthsOf(points, meeting));
  const FoundBeams passing = FindPassingBeams(points);
  if (good(passing, kCovered) && passing.points > meeting.points) {
    auto table = FindColumns(passing, true, AzimuthsOf(points, passing));
    if (table) FindReaches(points, passing, &*table);
    return table;
  }
  if (!good(meeting, kCovered)) return std::nullopt;
  return FindColumns(meeting, false, AzimuthsOf(points, meeting));
}

}  // namespace

std::optional<BeamTable> FindBeams(const std::vector<Sighting>& points) {
  auto table = FindExactBeams(points);
  if (table && !table->bends) RoundAngles(&*table);
  return table;
}

}  // namespace lidar::codec::cloud
