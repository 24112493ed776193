// SPDX-License-Identifier: LGPL-2.1-or-later
#include <algorithm>

#include "src/codec/mixing/model.h"

namespace lidar::codec::mixing {
namespace {

/// The weight of an input for which no weights were trained.
constexpr std::int16_t kNewWeight = 800;
// The lowest rates at which counters begin to adapt: the rate after 4 bits, and for the counters of
// the further candidates the rate after 8 bits.
constexpr std::uint16_t kLeastBinRate = RateAfter(4);
constexpr std::uint16_t kLeastFurtherRate = RateAfter(8);

template <std::size_t kSize>
void Hasten(std::array<Counter, kSize>* counters) {
  for (Counter& counter : *counters) counter.rate = std::max(counter.rate, kLeastBinRate);
}

/// Divides `sets` into as many equal parts as there are `rows`. Fills part i with copies of
/// rows[i].
template <std::size_t kRows, std::size_t kSize>
void Repeat(const std::array<Weights, kRows>& rows, std::array<Weights, kSize>* sets) {
  constexpr std::size_t kEach = kSize / kRows;
  for (std::size_t i = 0; i < kSize; ++i) (*sets)[i] = rows[i / kEach];
}

/// Returns for each node the mean of its sets of weights.
std::array<Weights, kSmallNodes> MeansOf(
    const std::array<Weights, kSmallNodes * kUnevenClasses>& sets) {
  std::array<Weights, kSmallNodes> means;
  for (std::size_t node = 0; node < kSmallNodes; ++node)
    for (std::size_t k = 0; k < kInputs; ++k) {
      std::int32_t sum = 0;
      for (std::size_t i = 0; i < kUnevenClasses; ++i)
        sum += sets[node * kUnevenClasses + i].values[k];
      means[node].values[k] =
          static_cast<std::int16_t>(sum / static_cast<std::int32_t>(kUnevenClasses));
    }
  return means;
}

}  // namespace

void Model::Refine() {
  Refinement& r = refinement;
  Hasten(&counters.mask);
  Hasten(&counters.range);
  for (Weights& set : weights.mask) set.values[kMaskContexts.size()] = kNewWeight;
  for (Weights& set : weights.jump)
    for (unsigned i = 0; i < Refinement::kFurther; ++i)
      set.values[kJumpContexts.size() + kCandidates + i] = kNewWeight;
  Repeat(weights.mask, &r.mask_columns);
  Repeat(weights.mask, &r.mask_runs);
  Repeat(MeansOf(weights.range), &r.ranges);
  Repeat(weights.jump, &r.gaps);
  r.mask.fill({});
  r.maps.fill({});
  // Each further candidate begins with the counters of a similar candidate.
  constexpr std::array<unsigned, Refinement::kFurther> kLike = {kCandidates - 1, kCandidates - 2,
                                                                kCandidates - 2};
  constexpr unsigned kEach = kJumpNodes * kPlaces;
  for (unsigned i = 0; i < Refinement::kFurther; ++i)
    for (unsigned k = 0; k < kEach; ++k) {
      Counter& counter = r.candidates[i * kEach + k];
      counter = counters.candidates[kLike[i] * kEach + k];
      counter.rate = std::max(counter.rate, kLeastFurtherRate);
    }
}

}  // namespace lidar::codec::mixing
