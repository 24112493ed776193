// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes jumps: differences of more than 3 bins from the prediction. After a jump, the value is
// often on the same surface as a neighbour.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "src/codec/mixing/bit_mixer.h"
#include "src/codec/mixing/model.h"
#include "src/codec/mixing/neighbours.h"

namespace lidar::codec::mixing {

struct JumpContext {
  std::uint32_t uneven = 0;
  std::uint32_t range_class = 0;  // class of the range and direction of the jump: 32 values
  std::uint32_t gap_class = 0;    // class of the gap and the step between neighbours: 16 values
  /// For each neighbour, the distance that a jump to its bin would have. It is 0 or less if the
  /// neighbour's bin is in the opposite direction, or too near for a jump.
  std::array<std::int32_t, kCandidates> candidates{};
  std::array<std::int32_t, Refinement::kFurther> further{};  // in refined models
};

template <unsigned kUsed, class Coder, bool kRefined = false>
class JumpPart {
 public:
  JumpPart(Model* model, Coder* coder) : model_(*model), coder_(*coder) {}

  static constexpr std::uint32_t kTooFar = 1U << 26;

  /// Codes `distance`, which is at least 1, and returns it. Returns kTooFar if the stream is
  /// damaged.
  std::uint32_t Code(std::uint32_t distance, const JumpContext& context) {
    context_ = &context;
    // An Exp-Golomb code: first the number of bits of `distance`, in unary, then the bits below the
    // highest one. Each CodeNode() codes whether `distance` is at least the middle of its Split.
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
    std::uint32_t half;  // half the width of the interval that is split
  };
  /// Returns the place of each candidate relative to the interval: from 1, far below its middle, to
  /// 10, far above. 0 means that the candidate is in the opposite direction, or is the prediction.
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
      const std::int32_t side = d >> 31;  // -1 if below the middle
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
