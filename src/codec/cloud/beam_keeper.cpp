// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/beam_keeper.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "src/codec/cloud/beam_columns.h"
#include "src/codec/cloud/beam_locator.h"
#include "src/codec/cloud/column_places.h"
#include "src/codec/cloud/path_fit.h"

namespace lidar::codec::cloud {
namespace {

constexpr unsigned kLongestPause = 64;

void PlaceOnBeams(const std::vector<Sighting>& points, const BeamTable& table,
                  std::vector<PlacedPoint>* placed) {
  const BeamLocator locator(table);
  const bool has_sides = table.has_offsets();
  placed->resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Sighting& s = points[i];
    const BeamLocator::Found found = locator.Find(s);
    const BeamTable::Beam& beam = table.beams[found.beam];
    std::int32_t azimuth = s.azimuth;
    if (has_sides) azimuth -= ToNearest(SideAngle(beam, s.rho_m));
    PlacedPoint& p = (*placed)[i];
    p.along_m = found.along_m;
    p.above_m = found.above_m;
    if (table.bends) {
      const double angle = std::atan2(found.above_m, found.along_m);
      p.bend = ToNearest(angle / kRadians);
      p.along_m = std::hypot(found.along_m, found.above_m);
      p.above_m = 0;
    }
    p.azimuth = azimuth & (kTurn - 1);
    p.beam = found.beam;
  }
}

/// Returns the azimuth less the offset of the beam.
std::int32_t StraightOf(const PlacedPoint& p, const BeamTable& table) {
  return (p.azimuth - table.beams[p.beam].offset) & (kTurn - 1);
}

void PlaceInColumns(const BeamTable& table, std::vector<PlacedPoint>* placed) {
  const ColumnFinder finder(table);
  for (PlacedPoint& p : *placed) {
    const ColumnFinder::Found found = finder.Find(p.beam, StraightOf(p, table));
    p.column = found.column;
    p.residual = found.residual;
  }
}

/// Returns the part of the points near their pixels.
double FitOf(const std::vector<Sighting>& points, const std::vector<PlacedPoint>& placed) {
  constexpr double kNear = 0.01;  // [m]
  std::size_t near = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double side = placed[i].residual * kRadians * points[i].rho_m;
    if (placed[i].above_m * placed[i].above_m + side * side < kNear * kNear) ++near;
  }
  return points.empty() ? 0 : static_cast<double>(near) / static_cast<double>(points.size());
}

/// Turns all beams by the most common distance from columns.
void ShiftColumns(const std::vector<PlacedPoint>& placed, BeamTable* table) {
  const double columns = 2 * M_PI * table->turn / BeamTable::kParts / kTurn;
  std::complex<double> phases;
  for (const PlacedPoint& p : placed) phases += std::polar(1.0, columns * p.residual);
  const double units = std::arg(phases) / columns / BeamTable::kBentOffset;
  const std::int32_t shift = BeamTable::kBentOffset * static_cast<std::int32_t>(std::lround(units));
  for (BeamTable::Beam& beam : table->beams) beam.offset = (beam.offset + shift) & (kTurn - 1);
}

}  // namespace

/// Finds the path of the points. Returns false if most are not on it.
bool BeamKeeper::PlaceOnNewPath(const std::vector<Sighting>& points,
                                const std::vector<Pulse>& pulses,
                                std::vector<PlacedPoint>* placed) {
  constexpr double kMost = 0.8;
  auto table = FindPath(points, pulses, placed);
  if (!table) return false;
  fit_ = FitOf(points, *placed);
  if (fit_ < kMost) return false;
  table_ = std::move(table);
  return true;
}

/// Returns false if the points fit worse than before.
bool BeamKeeper::PlaceByOld(const std::vector<Sighting>& points, const std::vector<Pulse>& pulses,
                            std::vector<PlacedPoint>* placed) {
  constexpr double kAlike = 0.97;
  if (table_->has_path()) return PlaceOnNewPath(points, pulses, placed);
  PlaceOnBeams(points, *table_, placed);
  const auto fit_in_columns = [&] {
    PlaceInColumns(*table_, placed);
    return FitOf(points, *placed) >= kAlike * fit_;
  };
  const bool may_stay = table_->grains == 0 || table_->bends;
  if (may_stay && fit_in_columns()) return true;
  if (table_->bends) {
    ShiftColumns(*placed, &*table_);
    return fit_in_columns();
  }
  std::vector<StraightAzimuth> straight;
  straight.reserve(placed->size());
  for (const PlacedPoint& p : *placed) straight.push_back({StraightOf(p, *table_), p.beam});
  const bool updated = UpdateColumns(straight, &*table_);
  return fit_in_columns() && updated;
}

const BeamTable* BeamKeeper::Place(const std::vector<Sighting>& points,
                                   const std::vector<Pulse>& pulses,
                                   std::vector<PlacedPoint>* placed) {
  if (points.size() > kMostPoints) return nullptr;
  if (table_ && PlaceByOld(points, pulses, placed)) {
    fails_ = 0;
    return &*table_;
  }
  ++fails_;
  constexpr unsigned kAtFirst = 4;
  const bool is_power = (fails_ & (fails_ - 1)) == 0;
  if (fails_ > kAtFirst && !is_power && fails_ % kLongestPause != 0)
    return table_ ? &*table_ : nullptr;
  if (PlaceOnNewPath(points, pulses, placed)) return &*table_;
  table_ = FindBeams(points);
  if (!table_) return nullptr;
  PlaceOnBeams(points, *table_, placed);
  PlaceInColumns(*table_, placed);
  fit_ = FitOf(points, *placed);
  return &*table_;
}

}  // namespace lidar::codec::cloud
