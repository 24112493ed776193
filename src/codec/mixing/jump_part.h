// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes distances of more than a few steps from the prediction. The value then often lies on a
// surface that a neighbour has seen.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "src/codec/mixing/bit_mixer.h"
#include "src/codec/mixing/model.h"
#include "src/codec/mixing/neighbours.h"

namespace lidar::codec::mixing {

/// Context of a jump.
struct JumpContext {
  std::uint32_t uneven = 0;
  std::uint32_t range_class = 0;  // and direction: 32 values
  std::uint32_t gap_class = 0;    // of gap and step between neighbours: 16 values
  /// Distances of neighbours in the direction of the jump.
  std::array<std::int32_t, kCandidates> candidates{};
  std::array<std::int32_t, Refinement::kFurther> further{};  // of refined models
};

template <unsigned kUsed, class Coder, bool kRefined = false>
class JumpPart {
 public:
  JumpPart(Model* model, Coder* coder) : model_(*model), coder_(*coder) {}

  static constexpr std::uint32_t kTooFar = 1U << 26;

  /// `distance` is 1 or more. Returns kTooFar for a damaged stream.
  std::uint32_t Code(std::uint32_t distance, const JumpContext& context) {
    context_ = &context;
    // An Exp-Golomb code: first the length, then the bits below the highest one. Each bit is 1 if
    // the distance reaches `middle`.
    unsigned length = 0;
    const auto last = static_cast<unsigned>(BitLength(distance) - 1);
    while (CodeNode(length < last, std::min(length, kLengthNodes - 1), context.gap_class,
                    {2U << length, 1U << length})) {
      if (++length == kMostLength) return kTooFar;
    }
    std::uint32_t value = 1U << length;
    for (unsigned place = length; place-- > 0;) {
      const std::uint32_t half = 1U << place;
      const unsigned level = std::min(length - 1 - place, 3U);
      const unsigned node = kLengthNodes + 6 * level + std::min(place, 5U);
      if (CodeNode((distance & half) != 0, node, std::min(length, 15U), {value + half, half}))
        value += half;
    }
    return value;
  }

 private:
  static constexpr unsigned kMostLength = 26;
  struct Split {
    std::uint32_t middle;
    std::uint32_t half;  // of the interval that is split
  };
  /// Places of candidates relative to the interval, 1 to 10; 0: the candidate is in the other
  /// direction.
  template <unsigned kCount, class Candidates>
  static std::array<std::int32_t, kCount> PlacesOf(const Split& split,
                                                   const Candidates& candidates) {
    const auto middle = static_cast<std::int32_t>(split.middle);
    const auto half = static_cast<std::int32_t>(split.half);
    const std::int32_t eighth = (half + 7) / 8;
    const std::int32_t quarter = (half + 1) / 2;
    std::array<std::int32_t, kCount> places;
    for (unsigned i = 0; i < kCount; ++i) {
      const std::int32_t candidate = candidates[i];
      const std::int32_t d = candidate - middle;
      const std::int32_t side = d >> 31;  // -1 below the middle
      const std::int32_t size = d ^ side;
      const std::int32_t far = (size >= eighth ? 1 : 0) + (size >= quarter ? 1 : 0) +
                               (size >= half ? 1 : 0) + (size >= 4 * half ? 1 : 0);
      const std::int32_t place = 6 + (far ^ side);
      places[i] = candidate <= -3 ? 0 : std::min(place, 11);
    }
    return places;
  }

  bool CodeNode(bool bit, unsigned node, std::uint32_t gap_class, const Split& split) {
    const JumpContext& c = *context_;
    constexpr std::uint32_t kSecond = kJumpNodes * kJumpContexts[0];
    constexpr std::uint32_t kThird = kSecond + kJumpNodes * kJumpContexts[1];
    const std::array<std::uint32_t, 3> values = {node * kJumpContexts[0] + c.uneven,
                                                 kSecond + node * kJumpContexts[1] + c.range_class,
                                                 kThird + node * kJumpContexts[2] + gap_class};
    const auto places = PlacesOf<kUsed>(split, c.candidates);
    const auto counter_at = [&](unsigned k) __attribute__((always_inline)) {
      if (k < 3) return &model_.counters.jump[values[k]];
      const auto place = static_cast<std::uint32_t>(places[k - 3]);
      return &model_.counters.candidates[((k - 3) * kJumpNodes + node) * kPlaces + place];
    };
    if constexpr (kRefined) {
      Refinement& r = model_.refinement;
      const auto further = PlacesOf<Refinement::kFurther>(split, c.further);
      BitMixer<3 + kUsed + Refinement::kFurther, 0> mixer;
      mixer.Ask([&](unsigned k) __attribute__((always_inline)) {
        if (k < 3 + kUsed) return counter_at(k);
        const unsigned i = k - 3 - kUsed;
        const auto place = static_cast<std::uint32_t>(further[i]);
        return &r.candidates[(i * kJumpNodes + node) * kPlaces + place];
      });
      return mixer.CodeFast(bit,
                            std::array{&model_.weights.jump[node],
                                       &r.gaps[node * Refinement::kGapSets + c.gap_class]},
                            nullptr, &coder_);
    } else {
      BitMixer<3 + kUsed, 0> mixer;
      mixer.Ask(counter_at);
      return mixer.Code(bit, &model_.weights.jump[node], &coder_);
    }
  }

  Model& model_;
  Coder& coder_;
  const JumpContext* context_ = nullptr;
};

}  // namespace lidar::codec::mixing
