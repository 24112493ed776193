// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes pixels. Each is predicted by the ranges that the same pixel had in earlier scans.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>

#include "src/codec/block_memory.h"
#include "src/codec/mixing/bit_mixer.h"
#include "src/codec/mixing/centre.h"
#include "src/codec/mixing/neighbours.h"
#include "src/codec/mixing/range_part.h"
#include "src/codec/mixing/slice_coder.h"

namespace lidar::codec::mixing {

template <class Coder>
class TemporalPart {
 public:
  TemporalPart(const RangeGrid& grid, TemporalModel* model, Coder* coder)
      : grid_(grid),
        divisor_(std::uint64_t{grid.unit_mm()} * grid.parts()),
        model_(*model),
        coder_(*coder) {}

  /// Begins a row. `pixels` has the memories of the `count` pixels in the row. `above[i]` is the
  /// azimuth of pixel i.
  void StartRow(const PixelMemory* pixels, std::uint32_t count, Surprise* above) {
    pixels_ = pixels;
    count_ = count;
    above_ = above;
    west_ = west2_ = {};
    north_west_ = above[-1];
    west_bit_ = false;
  }
  /// Selects pixel `i`. Must be called before the other functions for this pixel.
  void Look(std::uint32_t i) {
    const PixelMemory& p = pixels_[i];
    constexpr std::uint64_t kScale = std::uint64_t{kStep} * RangeGrid::kParts / PixelMemory::kPerMm;
    const std::uint64_t half_cell = std::uint64_t{grid_.unit_mm()} * PixelMemory::kPerMm / 2;
    const std::uint64_t value = (p.mean + half_cell) * kScale / divisor_;
    known_ = p.count > 0 && value < std::uint64_t{kStep} * kMostBins;
    value_ = known_ ? static_cast<std::int32_t>(value) : 0;
    const auto spread = std::min<std::uint64_t>(4 * kScale * p.spread / divisor_, 1 << 16);
    spread_class_ = std::min(HalfOctave(static_cast<std::uint32_t>(spread)), kSpreadClasses - 1);
    count_class_ = p.count < 3    ? std::max<std::uint32_t>(p.count, 1) - 1
                   : p.count < 5  ? 2
                   : p.count < 12 ? 3
                                  : 4;
    index_ = i;
  }
  /// Returns true if the memory probably predicts the bin better than the neighbours do.
  bool Knows() const {
    return known_ &&
           (west_.shift != Surprise::kChanged || above_[index_].shift != Surprise::kChanged);
  }

  /// Codes whether the pixel has a return. `mask_counters(k)` returns the counter of context k in
  /// MaskPart.
  template <class CounterAt>
  bool CodeReturn(bool bit, CounterAt&& mask_counters) {
    const PixelMemory& p = pixels_[index_];
    const Surprise& north = above_[index_];
    const Surprise& north_east = above_[index_ + 1];
    const std::uint32_t h = p.returns;
    const std::uint32_t east = index_ + 1 < count_ ? pixels_[index_ + 1].returns & 1U : 1U;
    const std::uint32_t west = west_bit_ ? 1 : 0;
    const std::uint32_t odd = (west_.returns ? 1U : 0U) | (north.returns ? 2U : 0U);
    const std::uint32_t first = (h * 2 + west) * 2 + (north.returns ? 1 : 0);
    const std::uint32_t second =
        ((((h & 7) * 2 + west) * 4 + odd) * 2 + east) * 2 + (north_east.returns ? 1 : 0);
    const std::uint32_t third =
        ((count_class_ * kSpreadClasses + spread_class_) * 4 + (h & 3)) * 2 + west;
    const std::array<std::uint32_t, 3> values = {
        first, kTemporalMaskContexts[0] + second,
        kTemporalMaskContexts[0] + kTemporalMaskContexts[1] + third};
    BitMixer<kSpatialMask + kTemporalMaskContexts.size(), 0> mixer;
    mixer.Ask([&](unsigned k) __attribute__((always_inline)) {
      return k < kSpatialMask ? mask_counters(k) : &model_.mask[values[k - kSpatialMask]];
    });
    return mixer.Code(bit, &model_.mask_weights[(h & 7) * 2 + west], &coder_);
  }

  /// Codes the bin of a pixel for which Knows() is true, and returns it. If the bin is more than 3
  /// bins from the recalled one, returns kFarAway, and the caller must code the bin.
  std::int32_t CodeBin(std::int32_t bin, const Surroundings& around) {
    base_ = value_ / kStep;
    const std::int32_t phase = value_ - CentreOf(base_);
    mirror_ = phase < 0 ? -1 : 1;
    SetContexts(static_cast<std::uint32_t>(std::abs(phase)), around);
    const std::int32_t difference = (bin - base_) * mirror_;
    if (!CodeNode(difference != 0, 0)) return Keep(base_, 0);
    const bool negative = CodeNode(difference < 0, 1);
    const std::int32_t size = std::abs(difference);
    std::int32_t coded = 1;
    while (coded < 4 && CodeNode(size > coded, static_cast<unsigned>(2 * coded + negative)))
      ++coded;
    if (coded == 4) return kFarAway;
    const std::int32_t signed_size = negative ? -coded : coded;
    return Keep(base_ + mirror_ * signed_size, signed_size);
  }

  /// Notes the bin of the pixel. Must be called for each return, however its bin was coded.
  void SeeBin(std::int32_t bin) {
    Surprise s;
    if (known_) {
      const std::int32_t apart = bin - value_ / kStep;
      s.shift = std::abs(apart) <= 3 ? static_cast<std::uint8_t>(apart + 3) : Surprise::kChanged;
    }
    See(s, true);
  }
  void SeeGap() {
    Surprise s;
    See(s, false);
  }

  static constexpr std::int32_t kFarAway = -1;
  static constexpr unsigned kSpatialMask = 3;

 private:
  static constexpr std::int32_t kMostBins = 1 << 25;

  static std::uint32_t Shift(const Surprise& s, std::int32_t mirror) {
    if (s.shift == Surprise::kChanged) return Surprise::kChanged;
    return static_cast<std::uint32_t>((s.shift - 3) * mirror + 3);
  }
  static std::uint32_t Size(const Surprise& s) {
    return static_cast<std::uint32_t>(std::abs(s.shift - 3));
  }
  static std::uint32_t Changed(const Surprise& s) { return s.shift == Surprise::kChanged ? 1 : 0; }

  void SetContexts(std::uint32_t phase, const Surroundings& around) {
    const PixelMemory& p = pixels_[index_];
    const Surprise& north = above_[index_];
    const Surprise& north_east = above_[index_ + 1];
    const auto offset = [&](std::int32_t value) {
      return OffsetClass((value - CentreOf(base_)) * mirror_);
    };
    const std::uint32_t coarse = phase / 3 < 3 ? phase / 3 : 2;
    const std::uint32_t activity = std::min(
        Size(west_) + Size(west2_) + Size(north) + Size(north_west_) + Size(north_east), 11U);
    const std::uint32_t changed =
        Changed(west_) | Changed(north) << 1 | Changed(north_west_) << 2 | Changed(north_east) << 3;
    const std::array<std::uint32_t, kTemporalContexts.size()> values = {
        (phase * kSpreadClasses + spread_class_) * kCountClasses + count_class_,
        ((Shift(west_, mirror_) * 8 + Shift(north, mirror_)) * 8 + Shift(north_east, mirror_)) * 3 +
            coarse,
        ((Shift(west_, mirror_) < 7 ? Shift(west_, mirror_) : 3) * 7 +
         (Shift(west2_, mirror_) < 7 ? Shift(west2_, mirror_) : 3)) *
                9 +
            phase,
        (offset(around.median) * 8 + around.uneven / 3) * 3 + coarse,
        (around.range_class * kSpreadClasses + spread_class_) * 3 + coarse,
        changed * 16 + (p.returns & 15U),
        (offset(around.w) * 11 + offset(around.n)) * 3 + coarse,
        activity * kSpreadClasses + spread_class_};
    std::uint32_t base = 0;
    for (unsigned k = 0; k < values.size(); ++k) {
      contexts_[k] = kSmallNodes * (base + values[k]);
      base += kTemporalContexts[k];
    }
    const std::int32_t centre = CentreOf(base_);
    centres_[0].Set((value_ - centre) * mirror_,
                    &model_.recalled_spread[spread_class_ * kCountClasses + count_class_]);
    centres_[1].Set((around.median - centre) * mirror_, &model_.spatial_spread[around.uneven]);
  }

  bool CodeNode(bool bit, unsigned node) {
    BitMixer<kTemporalContexts.size(), kTemporalCentres> mixer;
    mixer.Ask(
        [&](unsigned k)
            __attribute__((always_inline)) { return &model_.counters[contexts_[k] + node]; },
        [&](unsigned k) __attribute__((always_inline)) { return centres_[k].Opinion(node); });
    return mixer.Code(bit, &model_.weights[node * kSpreadClasses + spread_class_], &coder_);
  }

  std::int32_t Keep(std::int32_t bin, std::int32_t difference) {
    for (Centre& centre : centres_) centre.Learn(difference * kStep);
    return bin;
  }

  void See(Surprise s, bool is_return) {
    const PixelMemory& p = pixels_[index_];
    s.returns = ((p.returns & 1) != 0) != is_return;
    north_west_ = above_[index_];
    above_[index_] = s;
    west2_ = west_;
    west_ = s;
    west_bit_ = is_return;
  }

  const RangeGrid grid_;
  const std::uint64_t divisor_;
  TemporalModel& model_;
  Coder& coder_;

  // These members are set for each row.
  const PixelMemory* pixels_ = nullptr;
  std::uint32_t count_ = 0;
  Surprise* above_ = nullptr;
  Surprise west_, west2_, north_west_;
  bool west_bit_ = false;

  // These members are set for each pixel.
  std::uint32_t index_ = 0;
  bool known_ = false;
  std::int32_t value_ = 0;  // recalled, in 1/16 bin
  std::uint32_t spread_class_ = 0;
  std::uint32_t count_class_ = 0;
  std::int32_t base_ = 0;
  std::int32_t mirror_ = 1;
  std::array<std::uint32_t, kTemporalContexts.size()> contexts_{};
  std::array<Centre, kTemporalCentres> centres_;
};

}  // namespace lidar::codec::mixing
