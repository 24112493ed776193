// SPDX-License-Identifier: LGPL-2.1-or-later
// The models of the mixing coder, which learn within a slice.
#pragma once
#include <array>
#include <cstdint>

#include "src/codec/mixing/arithmetic.h"
#include "src/codec/mixing/bit_mixer.h"

namespace lidar::codec::mixing {

// The number of values of each context. The order is that of the contexts in mask_part.h,
// range_part.h, jump_part.h and level_part.h.
constexpr std::array<std::uint32_t, 6> kMaskContexts = {5'632, 4'096, 560, 4'096, 2'048, 1'024};
constexpr std::array<std::uint32_t, 13> kRangeContexts = {
    1'331, 1'372, 484, 512, 1'372, 1'936, 121, 120, 512, 24, 2'401, 1'024, 484};
constexpr std::array<std::uint32_t, 3> kJumpContexts = {24, 32, 64};
constexpr std::array<std::uint32_t, 14> kLevelContexts = {
    24, 225, 1'331, 1'024, 512, 1'331, 1'024, 1'024, 225, 405, 735, 1'372, 1'024, 225};

/// The number of decisions (nodes) on a small difference from a prediction: whether the difference
/// is 0, its sign, and for each sign whether its size is more than 1, 2 and 3.
constexpr unsigned kSmallNodes = 8;
/// The number of nodes in the Exp-Golomb code of a jump. The first kLengthNodes code the length.
/// The others code the bits below the highest one. Their node depends on the position of the bit
/// and on the number of bits coded before it.
constexpr unsigned kJumpNodes = 48;
constexpr unsigned kLengthNodes = 24;

constexpr unsigned kUnevenClasses = 24;
constexpr unsigned kSurfaces = 27;
constexpr unsigned kMeanPhases = 15;
constexpr unsigned kCandidates = 9;
constexpr unsigned kPlaces = 12;
constexpr unsigned kCentres = 2;

template <std::size_t kSize>
constexpr std::uint32_t Total(const std::array<std::uint32_t, kSize>& contexts) {
  std::uint32_t sum = 0;
  for (const std::uint32_t values : contexts) sum += values;
  return sum;
}

/// The counters for mask and bins.
struct BinCounters {
  std::array<Counter, Total(kMaskContexts)> mask;
  std::array<Counter, kSmallNodes * Total(kRangeContexts)> range;
  std::array<Counter, kJumpNodes * Total(kJumpContexts)> jump;
  std::array<Counter, kJumpNodes * kCandidates * kPlaces> candidates;
  /// The mean distance of values from each centre, in 1/4096 bin: one number for each class of
  /// unevenness, with and without a gap before the pixel.
  std::array<std::int32_t, kCentres * kUnevenClasses * 2> spread;
};
/// The weights for mask and bins.
struct BinWeights {
  std::array<Weights, 16> mask;
  std::array<Weights, kSmallNodes * kUnevenClasses> range;
  std::array<Weights, kSmallNodes * 64> event;
  std::array<Weights, kJumpNodes> jump;
};
/// The counters for intensities.
struct LevelCounters {
  std::array<Counter, kSmallNodes * Total(kLevelContexts)> small;
  std::array<Counter, 512> rest;
};
/// The weights for intensities.
struct LevelWeights {
  std::array<Weights, kSmallNodes * kUnevenClasses> uneven;
  std::array<Weights, kSmallNodes * kSurfaces> surfaces;
};

/// The additional parts of refined models, which are for sensors on which the start states were not
/// trained.
struct Refinement {
  static constexpr unsigned kMaskSets = 16;
  static constexpr unsigned kColumnSets = 64;
  static constexpr unsigned kRunSets = 16;
  static constexpr unsigned kRangeSets = 64;
  static constexpr unsigned kGapSets = 16;
  static constexpr unsigned kFurther = 3;  // candidates of a jump
  static constexpr std::uint32_t kMaskContext = 4'096;

  std::array<Weights, kMaskSets * kColumnSets> mask_columns;
  std::array<Weights, kMaskSets * kRunSets> mask_runs;
  std::array<Weights, kSmallNodes * kRangeSets> ranges;
  std::array<Weights, kJumpNodes * kGapSets> gaps;
  std::array<Counter, kMaskContext> mask;
  std::array<Counter, kJumpNodes * kFurther * kPlaces> candidates;
  std::array<ChanceMap, kSmallNodes * kMeanPhases> maps;
};

struct Model {
  BinCounters counters;
  BinWeights weights;
  LevelCounters level_counters;
  LevelWeights level_weights;
  Refinement refinement;

  /// Turns models of mask and bins that are in their start states into refined models. Refined
  /// models learn faster.
  void Refine();
};

}  // namespace lidar::codec::mixing
