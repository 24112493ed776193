// SPDX-License-Identifier: LGPL-2.1-or-later
// The temporal coder's model of successive scans. It is not reset for each block: what it has
// learnt from a block is used for the next block.
#pragma once
#include <array>
#include <cstdint>

#include "src/codec/mixing/model.h"

namespace lidar::codec::mixing {

constexpr unsigned kSpreadClasses = 12;
constexpr unsigned kCountClasses = 5;
constexpr unsigned kPhases = 9;

// The number of values of each context, in the order of the contexts in temporal_part.h.
constexpr std::array<std::uint32_t, 8> kTemporalContexts = {540, 1'536, 441, 264,
                                                            576, 256,   363, 144};
constexpr std::array<std::uint32_t, 3> kTemporalMaskContexts = {1'024, 256, 480};
constexpr unsigned kTemporalCentres = 2;
constexpr unsigned kTemporalMaskSets = 16;

struct TemporalModel {
  std::array<Counter, kSmallNodes * Total(kTemporalContexts)> counters;
  std::array<Counter, Total(kTemporalMaskContexts)> mask;
  /// The mean distance of values from the recalled one, in 1/4096 bin, for each class of spread and
  /// count.
  std::array<std::int32_t, kSpreadClasses * kCountClasses> recalled_spread;
  /// The mean distance of values from the spatial prediction, in 1/4096 bin, for each class of
  /// unevenness.
  std::array<std::int32_t, kUnevenClasses> spatial_spread;
  std::array<Weights, kSmallNodes * kSpreadClasses> weights;
  std::array<Weights, kTemporalMaskSets> mask_weights;

  void Reset() {
    counters.fill({});
    mask.fill({});
    recalled_spread.fill(2'048);
    spatial_spread.fill(4'096);
    constexpr std::int16_t kCounter = kWeightOne / 4;
    constexpr std::int16_t kRecalled = kWeightOne * 3 / 5;
    constexpr std::int16_t kSpatial = kWeightOne / 10;
    for (Weights& set : weights) {
      set.values.fill(0);
      for (unsigned i = 0; i < kTemporalContexts.size(); ++i) set.values[i] = kCounter;
      set.values[kTemporalContexts.size()] = kRecalled;
      set.values[kTemporalContexts.size() + 1] = kSpatial;
    }
    for (Weights& set : mask_weights) set.values.fill(kCounter);
  }
};

}  // namespace lidar::codec::mixing
