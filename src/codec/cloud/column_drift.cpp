// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/column_drift.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "src/codec/cloud/median.h"

namespace lidar::codec::cloud {
namespace {

constexpr std::size_t kSectors = 360;
constexpr std::uint32_t kDriftGrains = 36'000;  // 0.01 degrees
constexpr double kDriftGrain = static_cast<double>(kTurn) / kDriftGrains;
constexpr double kSector = static_cast<double>(kTurn) / kSectors;

/// Returns the azimuth in the middle of the widest gap in which no beam has a point.
std::int32_t WidestGap(const std::vector<BeamAzimuths>& beams) {
  std::vector<std::int32_t> all;
  for (const BeamAzimuths& azimuths : beams)
    for (const BeamAzimuth& a : azimuths) all.push_back(a.azimuth);
  std::sort(all.begin(), all.end());
  std::int32_t last = all.back() - kTurn;
  std::int32_t widest = 0;
  std::int32_t middle = 0;
  for (const std::int32_t azimuth : all) {
    if (azimuth - last > widest) {
      widest = azimuth - last;
      middle = last + widest / 2;
    }
    last = azimuth;
  }
  return middle & (kTurn - 1);
}

/// The mean drift of columns in each sector of a turn. The drift of a column is its distance from
/// the place that it would have at equal steps.
class Drift {
 public:
  bool known(double azimuth) const { return counts_[SectorOf(azimuth)] > 0; }
  void Add(double azimuth, double drift) {
    sums_[SectorOf(azimuth)] += drift;
    ++counts_[SectorOf(azimuth)];
  }
  double MeanAt(double azimuth) const {
    const std::size_t sector = SectorOf(azimuth);
    return counts_[sector] == 0 ? 0 : sums_[sector] / static_cast<double>(counts_[sector]);
  }
  /// Returns the drift of all sectors, smoothed. If the drift of a sector is unknown, it is that of
  /// the last known sector before it, or else of the first known sector.
  std::vector<double> Curve() const {
    std::vector<double> curve(kSectors);
    double last = 0;
    for (std::size_t i = kSectors; i-- > 0;)
      if (counts_[i] > 0) last = sums_[i] / static_cast<double>(counts_[i]);
    for (std::size_t i = 0; i < kSectors; ++i) {
      if (counts_[i] > 0) last = sums_[i] / static_cast<double>(counts_[i]);
      curve[i] = last;
    }
    return Smooth(curve);
  }

 private:
  static std::vector<double> Smooth(const std::vector<double>& curve) {
    constexpr std::size_t kAround = 3;
    std::vector<double> smooth;
    for (std::size_t i = 0; i < kSectors; ++i) {
      const std::size_t begin = i < kAround ? 0 : i - kAround;
      const std::size_t end = std::min(i + kAround + 1, kSectors);
      double sum = 0;
      for (std::size_t k = begin; k < end; ++k) sum += curve[k];
      smooth.push_back(sum / static_cast<double>(end - begin));
    }
    return smooth;
  }
  static std::size_t SectorOf(double azimuth) {
    return std::min(static_cast<std::size_t>(azimuth / kSector), kSectors - 1);
  }
  std::vector<double> sums_ = std::vector<double>(kSectors, 0);
  std::vector<std::size_t> counts_ = std::vector<std::size_t>(kSectors, 0);
};

/// A point's azimuth, and the distance of its column from the place that it would have at equal
/// steps.
struct Drifted {
  double azimuth;
  double drift;
};

/// Returns the drift of a beam's points. Follows the columns of the beam from one point to the
/// next. Where the beam has a gap, the drift of other beams is used.
std::vector<Drifted> FollowBeam(const BeamAzimuths& azimuths, std::int32_t first, double step,
                                const Drift& known) {
  std::vector<double> sorted;
  for (const BeamAzimuth& a : azimuths) sorted.push_back((a.azimuth - first) & (kTurn - 1));
  std::sort(sorted.begin(), sorted.end());
  std::vector<Drifted> followed;
  for (const double azimuth : sorted) {
    double expected = 0;
    if (!followed.empty()) {
      const Drifted& last = followed.back();
      expected = last.drift;
      if (azimuth - last.azimuth > kSector && known.known(azimuth) && known.known(last.azimuth))
        expected += known.MeanAt(azimuth) - known.MeanAt(last.azimuth);
    }
    const double column = std::round((azimuth - expected) / step);
    followed.push_back({azimuth, azimuth - column * step});
  }
  return followed;
}

std::int32_t RoundedOffset(double offset) {
  constexpr std::int32_t kUnit = BeamTable::kBentOffset;
  return kUnit * static_cast<std::int32_t>(std::lround(offset / kUnit)) & (kTurn - 1);
}

bool SetPlaces(const Drift& drift, double step, BeamTable* table) {
  const std::vector<double> curve = drift.Curve();
  const auto at = [&](double azimuth) {
    const double sector = std::clamp(azimuth / kSector - 0.5, 0.0, kSectors - 1.001);
    const auto below = static_cast<std::size_t>(sector);
    return curve[below] + (sector - static_cast<double>(below)) * (curve[below + 1] - curve[below]);
  };
  table->places.clear();
  for (double even = 0; even < kTurn; even += step) {
    const double place = (even + at(even) - curve[0]) / kTurn * kDriftGrains;
    const auto grain = static_cast<std::uint32_t>(std::lround(std::max(place, 0.0)));
    if (grain >= kDriftGrains) break;
    table->places.push_back(std::max(grain, table->places.empty() ? 0 : table->places.back()));
  }
  table->grains = kDriftGrains;
  table->turn = static_cast<std::uint32_t>(table->places.size()) * BeamTable::kParts;
  for (BeamTable::Beam& beam : table->beams) beam.offset = RoundedOffset(beam.offset + curve[0]);
  return table->columns() > 0 && table->columns() <= BeamTable::kMostColumns;
}

}  // namespace

bool FindDriftingPlaces(const std::vector<BeamAzimuths>& beams, double step, BeamTable* table) {
  const std::int32_t first = WidestGap(beams);
  // The step is rounded to whole grains, so that places at equal steps cost nothing.
  step = std::max(std::round(step / kDriftGrain), 1.0) * kDriftGrain;
  std::vector<std::size_t> order(beams.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return beams[a].size() > beams[b].size(); });
  Drift drift;
  for (const std::size_t b : order) {
    const std::vector<Drifted> followed = FollowBeam(beams[b], first, step, drift);
    std::vector<double> away;
    for (const Drifted& d : followed)
      if (drift.known(d.azimuth)) away.push_back(d.drift - drift.MeanAt(d.azimuth));
    const double offset = MedianOf(std::move(away));
    for (const Drifted& d : followed) drift.Add(d.azimuth, d.drift - offset);
    const double phase = offset - step * std::floor(offset / step);
    table->beams[b].offset = first + static_cast<std::int32_t>(std::lround(phase));
  }
  return SetPlaces(drift, step, table);
}

}  // namespace lidar::codec::cloud
