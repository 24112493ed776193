// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/column_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace lidar::codec::cloud {
namespace {

/// Some azimuths less the offsets of their beams, rising.
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

/// What the distances from the columns take [bit].
double ResidualBits(const std::vector<BeamAzimuths>& beams, const BeamTable& table) {
  const ColumnFinder finder(table);
  double bits = 0;
  for (std::uint32_t b = 0; b < beams.size(); ++b)
    for (const BeamAzimuth& a : beams[b]) {
      const std::uint32_t column = finder.ColumnOf(b, a.azimuth);
      const double off = std::abs(Wrapped(a.azimuth - table.AzimuthOf(b, column)));
      // In centimetres.
      bits += std::log2(1 + 100 * off * kRadians * static_cast<double>(a.rho_m));
    }
  return bits;
}

/// Follows the columns around the turn, as fast as they come.
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

/// Adds the firings that saw nothing.
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

/// Column 0 of all beams looks ahead.
void AlignDelays(BeamTable* table) {
  for (BeamTable::Beam& beam : table->beams) {
    const auto offset = static_cast<std::uint32_t>(beam.offset);
    const std::uint64_t ahead = std::uint64_t{kTurn - offset} * table->grains / kTurn;
    const auto at = std::lower_bound(table->places.begin(), table->places.end(), ahead);
    beam.delay = static_cast<std::uint32_t>(at - table->places.begin()) % table->columns();
  }
}

/// Beams of one firing look ahead and behind, and what is uneven is that of the firing.
class DelaySearch {
 public:
  DelaySearch(const std::vector<BeamAzimuths>& beams, const std::vector<double>& places,
              BeamTable* table)
      : beams_(beams), places_(places), table_(*table), size_(places.size()) {
    const ColumnFinder finder(table_);
    columns_.resize(beams.size());
    for (std::uint32_t b = 0; b < beams.size(); ++b)
      for (const BeamAzimuth& a : beams[b]) columns_[b].push_back(finder.ColumnOf(b, a.azimuth));
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
      const auto middle = misses.begin() + static_cast<std::ptrdiff_t>(misses.size() / 2);
      std::nth_element(misses.begin(), middle, misses.end());
      std::vector<std::size_t> good;
      for (std::size_t b = 0; b < beams_.size(); ++b)
        if (fits_[b].miss <= 2 * *middle) good.push_back(b);
      Average(good);
    }
    Write();
  }

 private:
  struct Fit {
    std::int32_t delay = 0;
    double offset = 0;
    double miss = 0;  // mean
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
    const auto middle = offs.begin() + static_cast<std::ptrdiff_t>(offs.size() / 2);
    std::nth_element(offs.begin(), middle, offs.end());
    Fit fit{delay, rough + *middle, 0};
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
  /// Places become what these beams say in the mean.
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
    // No place is below 0.
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

class RoundedColumns {
 public:
  RoundedColumns(const std::vector<BeamAzimuths>& beams, double quantum, double step)
      : beams_(beams),
        step_(step),
        grains_(static_cast<std::uint32_t>(std::lround(kTurn / quantum))) {
    votes_.assign(grains_, 0);
  }
  /// False where the beams do not agree.
  bool Find(BeamTable* table) {
    std::vector<std::uint32_t> order(beams_.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) {
      order[i] = i;
      grains_of_.push_back(GrainsOf(i));
    }
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return grains_of_[a].size() > grains_of_[b].size();
    });
    delays_.assign(beams_.size(), 0);
    for (int pass = 0; pass < 2; ++pass)
      for (const std::uint32_t b : order) {
        if (pass > 0) Vote(b, -1);
        delays_[b] = BestDelay(b);
        Vote(b, 1);
      }
    return Fill(table);
  }

 private:
  std::vector<std::uint32_t> GrainsOf(std::uint32_t beam) {
    const double quantum = static_cast<double>(kTurn) / grains_;
    phases_.push_back(MeanPhase(beams_[beam], quantum));
    std::vector<std::uint32_t> all;
    for (const BeamAzimuth& a : beams_[beam]) {
      const auto n = static_cast<std::int64_t>(std::lround(a.azimuth / quantum - phases_[beam]));
      all.push_back(static_cast<std::uint32_t>((n + grains_) % grains_));
    }
    return all;
  }
  std::uint32_t At(std::uint32_t grain, std::int32_t delay) const {
    const auto size = static_cast<std::int32_t>(grains_);
    return static_cast<std::uint32_t>((static_cast<std::int32_t>(grain) - delay + size) % size);
  }
  /// Some of the points say which delays are worth asking all of them.
  std::int32_t BestDelay(std::uint32_t beam) const {
    constexpr std::int32_t kMost = 160;
    constexpr std::size_t kSample = 256;
    std::array<std::uint64_t, 2 * kMost + 1> rough{};
    for (std::int32_t i = 0; i <= 2 * kMost; ++i)
      rough[static_cast<std::size_t>(i)] = VotesFor(beam, i - kMost, kSample);
    const std::uint64_t fewest = *std::max_element(rough.begin(), rough.end()) / 10 * 9;
    std::int32_t best = 0;
    std::uint64_t most = 0;
    for (std::int32_t i = 0; i <= 2 * kMost; ++i) {
      const std::int32_t delay = (i & 1) != 0 ? -(i + 1) / 2 : i / 2;
      if (rough[static_cast<std::size_t>(delay + kMost)] < fewest) continue;
      const std::uint64_t sum = VotesFor(beam, delay, SIZE_MAX);
      if (sum <= most) continue;
      most = sum;
      best = delay;
    }
    return best;
  }
  /// The votes where about so many of the points are.
  std::uint64_t VotesFor(std::uint32_t beam, std::int32_t delay, std::size_t sample) const {
    const std::vector<std::uint32_t>& grains = grains_of_[beam];
    const std::size_t stride = grains.size() / sample + 1;
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < grains.size(); i += stride)
      sum += static_cast<std::uint64_t>(std::min(votes_[At(grains[i], delay)], 8));
    return sum;
  }
  void Vote(std::uint32_t beam, int vote) {
    for (const std::uint32_t grain : grains_of_[beam]) votes_[At(grain, delays_[beam])] += vote;
  }
  bool Fill(BeamTable* table) const {
    std::uint64_t all = 0;
    for (const int v : votes_) all += static_cast<std::uint64_t>(v);
    const auto seen = grains_ - std::count(votes_.begin(), votes_.end(), 0);
    const double mean =
        static_cast<double>(all) / static_cast<double>(std::max<std::int64_t>(seen, 1));
    table->places.clear();
    std::uint64_t taken = 0;
    for (std::uint32_t i = 0; i < grains_; ++i) {
      if (static_cast<double>(votes_[i]) < mean / 4) continue;
      taken += static_cast<std::uint64_t>(votes_[i]);
      table->places.push_back(i);
    }
    if (static_cast<double>(taken) < 0.9 * static_cast<double>(all)) {
      table->places.clear();
      return false;
    }
    table->grains = grains_;
    table->places = WithGapsFilled(table->places, step_ / kTurn * grains_, grains_);
    table->turn = static_cast<std::uint32_t>(table->places.size()) * BeamTable::kParts;
    for (std::uint32_t b = 0; b < table->rows(); ++b) {
      const double azimuth = (delays_[b] + phases_[b]) / grains_ * kTurn;
      const auto offset = static_cast<std::int32_t>(std::lround(azimuth)) & (kTurn - 1);
      table->beams[b].offset = offset;
    }
    AlignDelays(table);
    return true;
  }

  const std::vector<BeamAzimuths>& beams_;
  double step_;
  std::uint32_t grains_;
  std::vector<int> votes_;
  std::vector<std::vector<std::uint32_t>> grains_of_;
  std::vector<double> phases_;
  std::vector<std::int32_t> delays_;
};

/// The strongest places, in columns, of a beam's points among `period` columns.
struct Swing {
  std::array<double, BeamTable::kMostPeriod> at{};  // less the column
  double covered = 0;                               // part of the points
};

Swing FindSwing(const BeamAzimuths& azimuths, std::uint32_t beam, const BeamTable& table,
                std::uint32_t period) {
  constexpr std::size_t kParts = 32;  // of a column
  const double step = static_cast<double>(kTurn) * BeamTable::kParts / table.turn;
  std::vector<double> histogram(period * kParts, 0);
  const ColumnFinder finder(table);
  for (const BeamAzimuth& a : azimuths) {
    const std::uint32_t column = finder.ColumnOf(beam, a.azimuth);
    const double off = Wrapped(a.azimuth - table.AzimuthOf(beam, column)) / step;
    const double at = (table.FiringOf(beam, column) % period + off + 0.5 / kParts) * kParts;
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

bool Swings(const BeamTable::Beam& beam) { return beam.swings != BeamTable::Beam{}.swings; }

/// Even columns begin elsewhere, or come faster.
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

/// Grains of which many points say that a firing is there; each by itself.
std::vector<std::uint32_t> VotedPlaces(const std::vector<StraightAzimuth>& azimuths,
                                       const BeamTable& table) {
  std::vector<std::uint32_t> votes(table.grains, 0);
  std::size_t all = 0;
  for (const StraightAzimuth& a : azimuths) {
    if (table.period > 1 && Swings(table.beams[a.beam])) continue;
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

/// Turns the swings to the firings that now are those of each.
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
      if (!Swings(table->beams[a.beam])) continue;
      const std::int32_t azimuth = a.azimuth + table->beams[a.beam].offset;
      const std::uint32_t column = finder.ColumnOf(a.beam, azimuth);
      sum += std::min(std::abs(Wrapped(azimuth - turned.AzimuthOf(a.beam, column))), 512);
      ++counted;
    }
    if (turn > 0 && sum >= least) continue;
    least = sum;
    best = std::move(turned);
  }
  *table = std::move(best);
}

}  // namespace

void Recentre(const std::vector<BeamAzimuths>& beams, BeamTable* table) {
  const std::int32_t reach = kTurn / static_cast<std::int32_t>(table->columns()) / 3;
  const ColumnFinder finder(*table);
  for (std::uint32_t b = 0; b < table->rows(); ++b) {
    std::vector<std::int32_t> residuals;
    for (const BeamAzimuth& a : beams[b]) {
      const std::uint32_t column = finder.ColumnOf(b, a.azimuth);
      const std::int32_t off = Wrapped(a.azimuth - table->AzimuthOf(b, column));
      if (std::abs(off) < reach) residuals.push_back(off);
    }
    if (residuals.empty()) continue;
    const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
    std::nth_element(residuals.begin(), middle, residuals.end());
    table->beams[b].offset = (table->beams[b].offset + *middle) & (kTurn - 1);
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

bool FindRoundedPlaces(const std::vector<BeamAzimuths>& beams, double quantum, double step,
                       BeamTable* table) {
  return RoundedColumns(beams, quantum, step).Find(table);
}

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
