// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the columns of sensors that round azimuths.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "src/codec/cloud/column_places.h"

namespace lidar::codec::cloud {
namespace {

/// Finds the multiples of `quantum` at which the sensor fires. The points of each beam vote for
/// them, shifted by the delay of the beam.
class RoundedColumns {
 public:
  RoundedColumns(const std::vector<BeamAzimuths>& beams, double quantum, double step)
      : beams_(beams),
        step_(step),
        grains_(static_cast<std::uint32_t>(std::lround(kTurn / quantum))) {
    votes_.assign(grains_, 0);
  }
  /// Sets the places of the columns and the offsets and delays of the beams. Returns false if the
  /// beams do not agree.
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
  /// Returns the delay with the most votes. All delays are rated by a sample of the points. The
  /// best ones are then rated by all points.
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
  /// Returns the sum of the votes at the places of about `sample` points. The places are those that
  /// the points of the beam have with this delay.
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

}  // namespace

bool FindRoundedPlaces(const std::vector<BeamAzimuths>& beams, double quantum, double step,
                       BeamTable* table) {
  return RoundedColumns(beams, quantum, step).Find(table);
}

}  // namespace lidar::codec::cloud
