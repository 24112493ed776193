// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/column_places.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "src/codec/cloud/median.h"

namespace lidar::codec::cloud {
namespace {

/// Returns a sorted sample of the azimuths, minus the offsets of their beams.
std::vector<std::int32_t> StraightSample(const std::vector<BeamAzimuths>& beams,
                                         const BeamTable& table) {
  constexpr std::size_t kOfColumn = 16;
  std::size_t all = 0;
  for (const BeamAzimuths& azimuths : beams) all += azimuths.size();
  const std::size_t stride = all / (kOfColumn * table.columns()) + 1;
  std::vector<std::int32_t> sample;
  std::size_t next = 0;
  for (std::uint32_t b = 0; b < table.rows(); ++b) {
    for (; next < beams[b].size(); next += stride)
      sample.push_back((beams[b][next].azimuth - table.beams[b].offset) & (kTurn - 1));
    next -= beams[b].size();
  }
  std::sort(sample.begin(), sample.end());
  return sample;
}

/// Returns the number of bits that the distances of all points from their columns would cost.
double ResidualBits(const std::vector<BeamAzimuths>& beams, const BeamTable& table) {
  const ColumnFinder finder(table);
  double bits = 0;
  for (std::uint32_t b = 0; b < beams.size(); ++b)
    for (const BeamAzimuth& a : beams[b]) {
      const double off = std::abs(finder.Find(b, a.azimuth - table.beams[b].offset).residual);
      const double off_cm = 100 * off * kRadians * static_cast<double>(a.rho_m);
      bits += std::log2(1 + off_cm);
    }
  return bits;
}

/// Finds the places of columns by following them around the turn. The step adapts to the points.
std::vector<double> FollowColumns(const std::vector<std::int32_t>& sample, double step) {
  constexpr std::size_t kFewestInColumn = 4;
  std::vector<double> places;
  std::size_t first = 0;
  for (double next = 0; next < kTurn - step / 2; next += step) {
    while (first < sample.size() && sample[first] < next - 0.45 * step) ++first;
    std::size_t end = first;
    while (end < sample.size() && sample[end] < next + 0.45 * step) ++end;
    if (end - first >= kFewestInColumn) {
      const double off = sample[first + (end - first) / 2] - next;
      next += off;
      step += off / 32;
    }
    places.push_back(std::max(next, 0.0));
    first = end;
  }
  return places;
}

void SetPlaces(const std::vector<double>& places, BeamTable* table) {
  constexpr std::uint32_t kGrains = 36'000;  // 0.01 degrees
  table->grains = kGrains;
  table->turn = static_cast<std::uint32_t>(places.size()) * BeamTable::kParts;
  table->places.clear();
  for (const double place : places) {
    const auto grain = static_cast<std::uint32_t>(std::lround(place / kTurn * kGrains));
    table->places.push_back(std::min(grain, kGrains - 1));
  }
}

/// Finds the delays and offsets of beams that point ahead of other beams or behind them. The uneven
/// steps are those of the firings, which are the same for all beams.
class DelaySearch {
 public:
  DelaySearch(const std::vector<BeamAzimuths>& beams, const std::vector<double>& places,
              BeamTable* table)
      : beams_(beams), places_(places), table_(*table), size_(places.size()) {
    const ColumnFinder finder(table_);
    columns_.resize(beams.size());
    for (std::uint32_t b = 0; b < beams.size(); ++b)
      for (const BeamAzimuth& a : beams[b])
        columns_[b].push_back(finder.Find(b, a.azimuth - table_.beams[b].offset).column);
  }
  void Run() {
    std::size_t largest = 0;
    for (std::size_t b = 1; b < beams_.size(); ++b)
      if (beams_[b].size() > beams_[largest].size()) largest = b;
    fits_.assign(beams_.size(), {});
    fits_[largest] = FitOf(largest, 0);
    Average({largest});
    for (int pass = 0; pass < 2; ++pass) {
      std::vector<double> misses;
      for (std::size_t b = 0; b < beams_.size(); ++b) {
        fits_[b] = BestFit(b);
        misses.push_back(fits_[b].miss);
      }
      const double median = MedianOf(std::move(misses));
      std::vector<std::size_t> good;
      for (std::size_t b = 0; b < beams_.size(); ++b)
        if (fits_[b].miss <= 2 * median) good.push_back(b);
      Average(good);
    }
    Write();
  }

 private:
  struct Fit {
    std::int32_t delay = 0;
    double offset = 0;
    double miss = 0;  // mean distance of points from the places
  };

  std::size_t FiringAt(std::size_t column, std::int32_t delay) const {
    const auto size = static_cast<std::int64_t>(size_);
    return static_cast<std::size_t>((static_cast<std::int64_t>(column) + delay + size) % size);
  }
  double Off(std::size_t b, std::size_t i, std::int32_t delay, double offset) const {
    const double place = places_[FiringAt(columns_[b][i], delay)];
    double off = beams_[b][i].azimuth - place - offset;
    return off - kTurn * std::round(off / kTurn);
  }
  Fit FitOf(std::size_t b, std::int32_t delay) const {
    constexpr std::size_t kSample = 120;
    const std::size_t stride = beams_[b].size() / kSample + 1;
    const double rough = -delay * static_cast<double>(kTurn) / static_cast<double>(size_);
    std::vector<double> offs;
    for (std::size_t i = 0; i < beams_[b].size(); i += stride)
      offs.push_back(Off(b, i, delay, rough));
    Fit fit{delay, rough + MedianOf(offs), 0};
    for (const double off : offs)
      fit.miss +=
          std::min(std::abs(off + rough - fit.offset), 512.0) / static_cast<double>(offs.size());
    return fit;
  }
  Fit BestFit(std::size_t b) const {
    constexpr std::int32_t kMost = 48;
    Fit best = FitOf(b, 0);
    for (std::int32_t delay = -kMost; delay <= kMost; ++delay) {
      const Fit fit = FitOf(b, delay);
      if (fit.miss < best.miss) best = fit;
    }
    return best;
  }
  /// Moves each place by the mean distance between the place and the points of `beams`.
  void Average(const std::vector<std::size_t>& beams) {
    std::vector<double> sums(size_, 0);
    std::vector<std::uint32_t> counts(size_, 0);
    const double step = static_cast<double>(kTurn) / static_cast<double>(size_);
    for (const std::size_t b : beams)
      for (std::size_t i = 0; i < beams_[b].size(); ++i) {
        const double off = Off(b, i, fits_[b].delay, fits_[b].offset);
        if (std::abs(off) > step / 4) continue;
        const std::size_t firing = FiringAt(columns_[b][i], fits_[b].delay);
        sums[firing] += off;
        ++counts[firing];
      }
    for (std::size_t i = 0; i < size_; ++i)
      if (counts[i] > 0) places_[i] += sums[i] / counts[i];
  }
  void Write() {
    // Places must not be below 0.
    const double least = *std::min_element(places_.begin(), places_.end());
    for (double& place : places_) place -= least;
    std::sort(places_.begin(), places_.end());
    SetPlaces(places_, &table_);
    for (std::size_t b = 0; b < beams_.size(); ++b) {
      const auto offset = static_cast<std::int32_t>(std::lround(fits_[b].offset + least));
      table_.beams[b].offset = offset & (kTurn - 1);
    }
    AlignDelays(&table_);
  }

  const std::vector<BeamAzimuths>& beams_;
  std::vector<double> places_;
  BeamTable& table_;
  std::size_t size_;
  std::vector<std::vector<std::uint32_t>> columns_;
  std::vector<Fit> fits_;
};

}  // namespace

std::vector<std::uint32_t> WithGapsFilled(const std::vector<std::uint32_t>& places, double step,
                                          std::uint32_t grains) {
  std::vector<std::uint32_t> filled;
  const auto fill_to = [&](std::uint32_t end) {
    const std::uint32_t last = filled.empty() ? 0 : filled.back();
    const auto gap = static_cast<std::uint32_t>(std::lround((end - last) / step));
    for (std::uint32_t k = 1; k < gap; ++k) filled.push_back(last + (end - last) * k / gap);
  };
  for (const std::uint32_t place : places) {
    fill_to(place);
    filled.push_back(place);
  }
  fill_to(grains);
  return filled;
}

void AlignDelays(BeamTable* table) {
  for (BeamTable::Beam& beam : table->beams) {
    const auto offset = static_cast<std::uint32_t>(beam.offset);
    const std::uint64_t ahead = std::uint64_t{kTurn - offset} * table->grains / kTurn;
    const auto at = std::lower_bound(table->places.begin(), table->places.end(), ahead);
    beam.delay = static_cast<std::uint32_t>(at - table->places.begin()) % table->columns();
  }
}

void Recentre(const std::vector<BeamAzimuths>& beams, BeamTable* table) {
  const std::int32_t reach = kTurn / static_cast<std::int32_t>(table->columns()) / 3;
  const ColumnFinder finder(*table);
  for (std::uint32_t b = 0; b < table->rows(); ++b) {
    std::vector<std::int32_t> residuals;
    for (const BeamAzimuth& a : beams[b]) {
      const std::int32_t off = finder.Find(b, a.azimuth - table->beams[b].offset).residual;
      if (std::abs(off) < reach) residuals.push_back(off);
    }
    if (residuals.empty()) continue;
    const std::int32_t median = MedianOf(std::move(residuals));
    table->beams[b].offset = (table->beams[b].offset + median) & (kTurn - 1);
  }
}

void FindPlaces(const std::vector<BeamAzimuths>& beams, double step, BeamTable* table) {
  constexpr double kPlaceBits = 3;
  table->turn = TurnOf(step);
  const auto sample = StraightSample(beams, *table);
  const std::vector<double> places = FollowColumns(sample, step);
  if (places.empty() || places.size() > BeamTable::kMostColumns) return;
  BeamTable placed = *table;
  SetPlaces(places, &placed);
  DelaySearch(beams, places, &placed).Run();
  const double saved = ResidualBits(beams, *table) - ResidualBits(beams, placed);
  if (saved > kPlaceBits * static_cast<double>(places.size())) *table = std::move(placed);
}

}  // namespace lidar::codec::cloud
