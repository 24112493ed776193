// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds beams whose steps from column to column are uneven in a periodic way.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "src/codec/cloud/column_places.h"

namespace lidar::codec::cloud {
namespace {

/// The places at which most points of a beam lie: one place for each of `period` successive
/// columns.
struct Swing {
  std::array<double, BeamTable::kMostPeriod> at{};  // distance from the column, in columns
  double covered = 0;                               // part of the points near a place
};

Swing FindSwing(const BeamAzimuths& azimuths, std::uint32_t beam, const BeamTable& table,
                std::uint32_t period) {
  constexpr std::size_t kParts = 32;  // bins per column
  const double step = static_cast<double>(kTurn) * BeamTable::kParts / table.turn;
  std::vector<double> histogram(period * kParts, 0);
  const ColumnFinder finder(table);
  for (const BeamAzimuth& a : azimuths) {
    const ColumnFinder::Found found = finder.Find(beam, a.azimuth - table.beams[beam].offset);
    const double off = found.residual / step;
    const double at = (table.FiringOf(beam, found.column) % period + off + 0.5 / kParts) * kParts;
    const auto size = static_cast<std::int64_t>(histogram.size());
    const auto place = static_cast<std::int64_t>(std::floor(at));
    histogram[static_cast<std::size_t>((place + size) % size)] += 1;
  }
  Swing swing;
  std::array<double, BeamTable::kMostPeriod> peaks{};
  for (std::uint32_t i = 0; i < period; ++i) {
    const auto peak = static_cast<std::size_t>(
        std::max_element(histogram.begin(), histogram.end()) - histogram.begin());
    double weight = 0;
    double moment = 0;
    for (std::size_t k = 0; k < 5; ++k) {
      double& part = histogram[(peak + k + histogram.size() - 2) % histogram.size()];
      weight += part;
      moment += part * (static_cast<double>(k) - 2);
      part = 0;
    }
    swing.covered += weight / static_cast<double>(azimuths.size());
    peaks[i] = (static_cast<double>(peak) + (weight > 0 ? moment / weight : 0)) / kParts;
  }
  std::sort(peaks.begin(), peaks.begin() + period);
  double least = 1e9;
  for (std::uint32_t shift = 0; shift < period; ++shift) {
    std::array<double, BeamTable::kMostPeriod> at{};
    double sum = 0;
    for (std::uint32_t i = 0; i < period; ++i) {
      const std::uint32_t column = (i + shift) % period;
      double off = peaks[i] - column;
      off -= period * std::round(off / period);
      at[column] = off;
      sum += std::abs(off);
    }
    if (sum >= least) continue;
    least = sum;
    swing.at = at;
  }
  return swing;
}

}  // namespace

void FindSwings(const std::vector<BeamAzimuths>& beams, BeamTable* table) {
  const double step = static_cast<double>(kTurn) * BeamTable::kParts / table->turn;
  BeamTable best = *table;
  double most = 0;
  for (std::uint32_t b = 0; b < table->rows(); ++b)
    most += FindSwing(beams[b], b, *table, 1).covered;
  most += 0.03 * table->rows();
  for (std::uint32_t period = 2; period <= BeamTable::kMostPeriod; ++period) {
    BeamTable swung = *table;
    swung.period = period;
    double covered = 0;
    for (std::uint32_t b = 0; b < table->rows(); ++b) {
      const double even = FindSwing(beams[b], b, *table, 1).covered;
      const Swing swing = FindSwing(beams[b], b, *table, period);
      const bool swings = swing.covered > even + 0.1;
      covered += swings ? swing.covered : even;
      for (std::uint32_t k = 0; k < period && swings; ++k) {
        const double units = std::round(swing.at[k] * step / BeamTable::kSwingUnit);
        swung.beams[b].swings[k] = static_cast<std::int32_t>(units) * BeamTable::kSwingUnit;
      }
    }
    if (covered <= most) continue;
    most = covered;
    best = std::move(swung);
  }
  *table = std::move(best);
}

void TurnSwings(const std::vector<StraightAzimuth>& azimuths, BeamTable* table) {
  BeamTable best = *table;
  double least = 0;
  for (std::uint32_t turn = 0; turn < table->period; ++turn) {
    BeamTable turned = *table;
    for (BeamTable::Beam& beam : turned.beams)
      std::rotate(beam.swings.begin(), beam.swings.begin() + turn,
                  beam.swings.begin() + table->period);
    const ColumnFinder finder(turned);
    double sum = 0;
    std::size_t counted = 0;
    for (std::size_t i = 0; i < azimuths.size() && counted < 2'000; i += 7) {
      const StraightAzimuth& a = azimuths[i];
      if (!table->beams[a.beam].Swings()) continue;
      sum += std::min(std::abs(finder.Find(a.beam, a.azimuth).residual), 512);
      ++counted;
    }
    if (turn > 0 && sum >= least) continue;
    least = sum;
    best = std::move(turned);
  }
  *table = std::move(best);
}

}  // namespace lidar::codec::cloud
