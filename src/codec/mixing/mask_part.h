// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes whether a pixel has a return.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "src/codec/mixing/bit_mixer.h"
#include "src/codec/mixing/model.h"
#include "src/codec/mixing/neighbours.h"

namespace lidar::codec::mixing {

/// Codes the mask. If kRefined, there is one more context, which has further pixels of the row.
template <unsigned kContexts, class Coder, bool kRefined = false>
class MaskPart {
 public:
  MaskPart(Model* model, Coder* coder) : model_(*model), coder_(*coder) {}

  /// Begins a row. `above[i]` is the azimuth of pixel i. `above` points into an AlignedRow, because
  /// indices past both ends of the row are read, too.
  void StartRow(const Azimuth* above) {
    above_ = above;
    west_ = (above[0].returns & 1) != 0 ? 0xFF : 0;
    run_ = 0;
    nearby_ = 0;
    for (int i = -2; i < 8; ++i) nearby_ |= (above[i].returns & 1U) << (i + 2);
    north_west_ = above[-1].returns;
  }

  /// Codes whether pixel `i` has a return. `near_class` is the range class of the nearest return.
  [[gnu::always_inline]] bool Code(bool bit, std::uint32_t i, std::uint32_t near_class) {
    nearby_ |= (above_[static_cast<std::ptrdiff_t>(i) + 8 - 1].returns & 1U) << 9;
    SetContexts(i, near_class);
    const std::uint32_t set = (west_ & 1) << 3 | (nearby_ >> 1 & 7);
    if constexpr (kRefined) {
      bit = CodeRefined(bit, i, set);
    } else {
      BitMixer<kContexts, 0> mixer;
      mixer.Ask([&](unsigned k) __attribute__((always_inline)) { return CounterAt(k); });
      bit = mixer.Code(bit, &model_.weights.mask[set], &coder_);
    }
    Keep(bit, i);
    return bit;
  }
  /// Does the same as Code(), but has the bit coded by `code(bit, counter_at)`. `counter_at(k)`
  /// returns the counter of context k.
  template <class Code>
  bool CodeBy(bool bit, std::uint32_t i, std::uint32_t near_class, Code&& code) {
    nearby_ |= (above_[static_cast<std::ptrdiff_t>(i) + 8 - 1].returns & 1U) << 9;
    SetContexts(i, near_class);
    bit = code(bit, [&](unsigned k) { return CounterAt(k); });
    Keep(bit, i);
    return bit;
  }

 private:
  Counter* CounterAt(unsigned k) { return &model_.counters.mask[contexts_[k]]; }

  [[gnu::always_inline]] bool CodeRefined(bool bit, std::uint32_t i, std::uint32_t set) {
    Refinement& r = model_.refinement;
    Counter* const further = &r.mask[(west_ & 0xFF) * 16 + (nearby_ >> 2 & 15)];
    const std::uint32_t columns = (above_[i].returns & 15U) * 4 + (west_ >> 1 & 3);
    const std::uint32_t run = std::min(run_, Refinement::kRunSets - 1);
    BitMixer<kContexts + 1, 0> mixer;
    mixer.Ask([&](unsigned k) __attribute__((always_inline)) {
      return k < kContexts ? CounterAt(k) : further;
    });
    return mixer.CodeFast(bit,
                          std::array{&model_.weights.mask[set],
                                     &r.mask_columns[set * Refinement::kColumnSets + columns],
                                     &r.mask_runs[set * Refinement::kRunSets + run]},
                          nullptr, &coder_);
  }

  void Keep(bool bit, std::uint32_t i) {
    run_ = ((west_ & 1) != 0) == bit ? std::min(run_ + 1, 255U) : 1;
    west_ = west_ << 1 | (bit ? 1 : 0);
    north_west_ = above_[i].returns;
    nearby_ >>= 1;
  }

  [[gnu::always_inline]] void SetContexts(std::uint32_t i, std::uint32_t near_class) {
    // The five pixels above: bit 0 is two columns to the left of pixel i, bit 2 directly above it.
    const std::uint32_t five = nearby_ & 31;
    const std::uint32_t north = above_[i].returns;
    const std::uint32_t east = above_[i + 1].returns;
    const std::uint32_t ahead = nearby_ >> 2;
    const std::uint32_t change = (ahead & 1) != 0 ? ~ahead : ahead;
    const auto run_above = static_cast<std::uint32_t>(__builtin_ctz(change | 1U << 8));
    const std::uint32_t last = west_ & 1;
    const std::uint32_t short_run = run_ < 8 ? run_ : run_ < 16 ? 8 : run_ < 32 ? 9 : 10;
    const auto log_run = static_cast<std::uint32_t>(BitLength(std::min(run_, 63U)));
    const auto log_above = static_cast<std::uint32_t>(BitLength(run_above));
    const std::array<std::uint32_t, kMaskContexts.size()> values = {
        ((short_run * 2 + last) * 8 + run_above - 1) * 32 + five,
        (((north & 15) * 8 + (north_west_ & 7)) * 8 + (east & 7)) * 4 + (west_ & 3),
        ((log_run * 2 + last) * 5 + log_above) * 8 + (five >> 1 & 7),
        ((north & 63) * 4 + (west_ & 3)) * 16 + ((nearby_ >> 4 & 3) | (east & 3) << 2),
        (west_ & 63) * 32 + five,
        near_class * 64 + (west_ & 3) * 16 + (five >> 1 & 7) * 2};
    std::uint32_t base = 0;
    for (unsigned k = 0; k < kContexts; ++k) {
      contexts_[k] = base + values[k];
      base += kMaskContexts[k];
    }
  }

  Model& model_;
  Coder& coder_;
  const Azimuth* above_ = nullptr;
  std::uint32_t west_ = 0;    // the last pixels of the row, the newest in bit 0
  std::uint32_t run_ = 0;     // the number of equal pixels up to the last one
  std::uint32_t nearby_ = 0;  // pixels of the row above; bit 0: two columns to the left
  std::uint32_t north_west_ = 0;
  std::array<std::uint32_t, kContexts> contexts_{};
};

}  // namespace lidar::codec::mixing
