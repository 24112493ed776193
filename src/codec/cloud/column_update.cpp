// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the columns of the next cloud from the columns of the last cloud.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "src/codec/cloud/column_places.h"

namespace lidar::codec::cloud {
namespace {

/// Adapts columns that have equal steps: changes the step, and the offsets of all beams.
bool UpdateEvenColumns(const std::vector<StraightAzimuth>& azimuths, BeamTable* table) {
  constexpr std::size_t kSample = 2'048;
  constexpr std::size_t kParts = 16;
  std::vector<BeamAzimuths> parts(kParts);
  const std::size_t stride = azimuths.size() / kSample + 1;
  std::size_t next = 0;
  for (std::size_t i = 0; i < azimuths.size(); i += stride)
    parts[next++ % kParts].push_back({azimuths[i].azimuth, 1});
  const double step =
      AlignedStep(parts, static_cast<double>(kTurn) * BeamTable::kParts / table->turn);
  BeamAzimuths all;
  for (const BeamAzimuths& part : parts) all.insert(all.end(), part.begin(), part.end());
  if (all.empty()) return false;
  table->turn = TurnOf(step);
  const auto shift = static_cast<std::int32_t>(std::lround(PhaseAt(all, step) * step));
  for (BeamTable::Beam& beam : table->beams) beam.offset = (beam.offset + shift) & (kTurn - 1);
  return table->columns() > 0 && table->columns() <= BeamTable::kMostColumns;
}

/// Returns the places of the firings. They are the grains with many points, one grain for each
/// firing.
std::vector<std::uint32_t> VotedPlaces(const std::vector<StraightAzimuth>& azimuths,
                                       const BeamTable& table) {
  std::vector<std::uint32_t> votes(table.grains, 0);
  std::size_t all = 0;
  for (const StraightAzimuth& a : azimuths) {
    if (table.period > 1 && table.beams[a.beam].Swings()) continue;
    const std::uint64_t grain =
        (std::uint64_t{static_cast<std::uint32_t>(a.azimuth)} * table.grains + kTurn / 2) / kTurn;
    ++votes[grain == table.grains ? 0 : grain];
    ++all;
  }
  const std::size_t fewest = all / table.places.size() / 8 + 1;
  const double step = static_cast<double>(table.grains) * BeamTable::kParts / table.turn;
  std::vector<std::uint32_t> places;
  for (std::uint32_t i = 0; i < table.grains; ++i) {
    if (votes[i] < fewest) continue;
    if (!places.empty() && i - places.back() < 0.5 * step) {
      if (votes[i] > votes[places.back()]) places.back() = i;
      continue;
    }
    places.push_back(i);
  }
  return WithGapsFilled(places, step, table.grains);
}

}  // namespace

bool UpdateColumns(const std::vector<StraightAzimuth>& azimuths, BeamTable* table) {
  if (table->grains == 0) return UpdateEvenColumns(azimuths, table);
  std::vector<std::uint32_t> places = VotedPlaces(azimuths, *table);
  if (places.size() < table->places.size() / 2 || places.size() > BeamTable::kMostColumns)
    return false;
  table->turn = static_cast<std::uint32_t>(places.size()) * BeamTable::kParts;
  table->places = std::move(places);
  AlignDelays(table);
  if (table->period > 1) TurnSwings(azimuths, table);
  return true;
}

}  // namespace lidar::codec::cloud
