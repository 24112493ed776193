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

bool IsNear(const Sighting& s, const PlacedPoint& p) {
  constexpr double kNear = 0.01;  // [m]
  const double side = p.residual * kRadians * s.rho_m;
  return p.above_m * p.above_m + side * side < kNear * kNear;
}

double PartOf(std::size_t near, std::size_t all) {
  return all == 0 ? 0 : static_cast<double>(near) / static_cast<double>(all);
}

/// Places points on beams, and then in columns.
class Placer {
 public:
  Placer(const std::vector<Sighting>& points, const BeamTable& table,
         std::vector<PlacedPoint>* placed)
      : points_(points), table_(table), has_sides_(table.has_offsets()), placed_(*placed) {}

  void PlaceOnBeams() {
    const BeamLocator locator(table_);
    placed_.resize(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) PlaceOnBeam(locator, points_[i], &placed_[i]);
  }
  /// Places points in columns. They must already be on beams. Returns the part of the points that
  /// are near their pixels.
  double PlaceInColumns() {
    const ColumnFinder finder(table_);
    std::size_t near = 0;
    for (std::size_t i = 0; i < points_.size(); ++i)
      near += PlaceInColumn(finder, points_[i], &placed_[i]);
    return PartOf(near, points_.size());
  }
  /// Places points on beams and in columns, in one pass. Returns the part of the points that are
  /// near their pixels.
  double Place() {
    const BeamLocator locator(table_);
    const ColumnFinder finder(table_);
    placed_.resize(points_.size());
    std::size_t near = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      PlaceOnBeam(locator, points_[i], &placed_[i]);
      near += PlaceInColumn(finder, points_[i], &placed_[i]);
    }
    return PartOf(near, points_.size());
  }
  /// Returns the azimuth of `p` minus the offset of its beam.
  std::int32_t StraightOf(const PlacedPoint& p) const {
    return (p.azimuth - table_.beams[p.beam].offset) & (kTurn - 1);
  }

 private:
  void PlaceOnBeam(const BeamLocator& locator, const Sighting& s, PlacedPoint* p) const {
    const BeamLocator::Found found = locator.Find(s);
    std::int32_t azimuth = s.azimuth;
    if (has_sides_) azimuth -= ToNearest(SideAngle(table_.beams[found.beam], s.rho_m));
    p->along_m = found.along_m;
    p->above_m = found.above_m;
    if (table_.bends) {
      const double angle = AngleOf(found.above_m, found.along_m);
      p->bend = ToNearest(angle / kRadians);
      p->along_m = std::sqrt(found.along_m * found.along_m + found.above_m * found.above_m);
      p->above_m = 0;
    }
    p->azimuth = azimuth & (kTurn - 1);
    p->beam = found.beam;
  }
  /// Returns 1 if the point is near its pixel, otherwise 0.
  unsigned PlaceInColumn(const ColumnFinder& finder, const Sighting& s, PlacedPoint* p) const {
    const ColumnFinder::Found found = finder.Find(p->beam, StraightOf(*p));
    p->column = found.column;
    p->residual = found.residual;
    return IsNear(s, *p) ? 1 : 0;
  }

  const std::vector<Sighting>& points_;
  const BeamTable& table_;
  bool has_sides_;
  std::vector<PlacedPoint>& placed_;
};

/// Returns the part of the points that are near their pixels.
double FitOf(const std::vector<Sighting>& points, const std::vector<PlacedPoint>& placed) {
  std::size_t near = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (IsNear(points[i], placed[i])) ++near;
  return PartOf(near, points.size());
}

/// Adds the mean distance of the points from their columns to the offsets of all beams.
void ShiftColumns(const std::vector<PlacedPoint>& placed, BeamTable* table) {
  const double columns = 2 * M_PI * table->turn / BeamTable::kParts / kTurn;
  std::complex<double> phases;
  for (const PlacedPoint& p : placed) phases += std::polar(1.0, columns * p.residual);
  const double units = std::arg(phases) / columns / BeamTable::kBentOffset;
  const std::int32_t shift = BeamTable::kBentOffset * static_cast<std::int32_t>(std::lround(units));
  for (BeamTable::Beam& beam : table->beams) beam.offset = (beam.offset + shift) & (kTurn - 1);
}

}  // namespace

/// Finds a path of the points, and places the points on it. Returns false if there is none, or if
/// too few points are near it.
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

/// Places points on the beams of earlier clouds. Returns false if clearly fewer of the points are
/// near their pixels than in the cloud in which the beams were found.
bool BeamKeeper::PlaceByOld(const std::vector<Sighting>& points, const std::vector<Pulse>& pulses,
                            std::vector<PlacedPoint>* placed) {
  constexpr double kAlike = 0.97;
  if (table_->has_path()) return PlaceOnNewPath(points, pulses, placed);
  Placer placer(points, *table_, placed);
  const bool may_stay = table_->grains == 0 || table_->bends;
  if (may_stay) {
    if (placer.Place() >= kAlike * fit_) return true;
  } else {
    placer.PlaceOnBeams();
  }
  if (table_->bends) {
    ShiftColumns(*placed, &*table_);
    return placer.PlaceInColumns() >= kAlike * fit_;
  }
  std::vector<StraightAzimuth> straight;
  straight.reserve(placed->size());
  for (const PlacedPoint& p : *placed) straight.push_back({placer.StraightOf(p), p.beam});
  const bool updated = UpdateColumns(straight, &*table_);
  return placer.PlaceInColumns() >= kAlike * fit_ && updated;
}

const BeamTable* BeamKeeper::Place(const std::vector<Sighting>& points,
                                   const std::vector<Pulse>& pulses, const std::vector<Point>& all,
                                   std::vector<PlacedPoint>* placed) {
  if (all.size() > kMostPoints) return nullptr;
  if (table_ && PlaceByOld(points, pulses, placed)) {
    fails_ = 0;
    return &*table_;
  }
  ++fails_;
  constexpr unsigned kAtFirst = 4;
  const bool is_power = (fails_ & (fails_ - 1)) == 0;
  if (fails_ > kAtFirst && !is_power && fails_ % kLongestPause != 0) {
    // If the table has a path, the points are not placed, because PlaceByOld() found no new path.
    return table_ && !table_->has_path() ? &*table_ : nullptr;
  }
  if (PlaceOnNewPath(points, pulses, placed)) {
    fails_ = 0;
    return &*table_;
  }
  std::vector<Sighting> sightings;
  SightAll(all, all.size(), &sightings);
  table_ = FindBeams(sightings);
  if (!table_) return nullptr;
  fit_ = Placer(points, *table_, placed).Place();
  return &*table_;
}

}  // namespace lidar::codec::cloud
