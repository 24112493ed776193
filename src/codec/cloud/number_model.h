// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes signed integers bit by bit. The bits are predicted by several contexts.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "src/codec/mixing/bit_mixer.h"

namespace lidar::codec::cloud {

/// Codes bits of `kNodes` kinds. Each bit is predicted by several contexts. The counters of a
/// context are created when the context first occurs, because a small cloud has few contexts.
template <unsigned kContexts, std::uint32_t kNodes>
class BitModel {
 public:
  static constexpr std::uint32_t kValues = 512;  // number of values of a context
  using Contexts = std::array<std::uint32_t, kContexts>;

  BitModel() {
    for (mixing::Weights& w : weights_) w.values.fill(mixing::kWeightOne / 3);
    counters_.reserve(kContexts * kValues);  // so that pointers to counters stay valid
  }

  template <class Coder>
  bool CodeBit(bool bit, std::uint32_t node, const Contexts& contexts, Coder* coder) {
    return CodeBit(bit, node, Find(contexts), coder);
  }

 protected:
  using Counters = std::array<mixing::Counter, kNodes>;
  using Found = std::array<Counters*, kContexts>;

  Found Find(const Contexts& contexts) {
    Found found;
    for (unsigned k = 0; k < kContexts; ++k) {
      std::uint16_t& place = places_[k][contexts[k] % kValues];
      if (place == 0) {
        counters_.emplace_back();
        place = static_cast<std::uint16_t>(counters_.size());
      }
      found[k] = &counters_[place - 1U];
    }
    return found;
  }
  template <class Coder>
  bool CodeBit(bool bit, std::uint32_t node, const Found& found, Coder* coder) {
    mixing::BitMixer<kContexts, 0> mixer;
    mixer.Ask([&](unsigned k) __attribute__((always_inline)) { return &(*found[k])[node]; });
    return mixer.Code(bit, &weights_[node], coder);
  }

 private:
  /// The index in counters_ of each context's counters, plus 1. It is 0 if there are none yet.
  std::array<std::array<std::uint16_t, kValues>, kContexts> places_{};
  std::vector<Counters> counters_;
  std::array<mixing::Weights, kNodes> weights_{};
};

/// Codes signed integers. Bits say whether a number is 0, its sign, its length, and its lower bits.
template <unsigned kContexts>
class NumberModel : public BitModel<kContexts, 128> {
 public:
  static constexpr std::uint32_t kNodes = 128;
  static constexpr std::int32_t kTooLarge = 1 << 26;
  using Contexts = typename BitModel<kContexts, kNodes>::Contexts;

  /// Codes and returns `number`. Returns kTooLarge if the stream is damaged.
  template <class Coder>
  std::int32_t Code(std::int32_t number, const Contexts& contexts, Coder* coder) {
    const auto found = this->Find(contexts);
    if (!this->CodeBit(number != 0, 0, found, coder)) return 0;
    const bool negative = this->CodeBit(number < 0, 1, found, coder);
    const auto size = static_cast<std::uint32_t>(negative ? -number : number);
    // This is an Exp-Golomb code.
    const auto wanted = static_cast<unsigned>(mixing::BitLength(size | 1) - 1);
    unsigned length = 0;
    while (this->CodeBit(length < wanted, (negative ? 32 : 2) + length, found, coder))
      if (++length == 26) return kTooLarge;
    std::uint32_t value = 1;
    for (unsigned place = length; place-- > 0;) {
      const bool top = place + 1 == length;
      const std::uint32_t node = 64 + (top ? length : 32 + place);
      value = value << 1 | (this->CodeBit((size >> place & 1) != 0, node, found, coder) ? 1U : 0U);
    }
    const auto result = static_cast<std::int32_t>(value);
    return negative ? -result : result;
  }
};

}  // namespace lidar::codec::cloud
