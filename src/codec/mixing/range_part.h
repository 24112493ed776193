// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes the bin of a return.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>

#include "src/codec/mixing/bit_mixer.h"
#include "src/codec/mixing/centre.h"
#include "src/codec/mixing/jump_part.h"
#include "src/codec/mixing/model.h"
#include "src/codec/mixing/neighbours.h"

namespace lidar::codec::mixing {

/// Only bins below this number are coded, so that sums of a few values in 1/16 bin fit 32 bits.
constexpr std::int32_t kMaxBins = 1 << 25;

/// The neighbours of a return (`w` to the left, `n` above), and what is derived from them.
struct Surroundings {
  std::int32_t w = 0;
  std::int32_t n = 0;
  std::int32_t median = 0;  // the prediction
  std::uint32_t uneven = 0;
  std::uint32_t range_class = 0;
};

/// Codes bins. `Effort` has the numbers of contexts, centres and candidates, and two flags. With
/// kEvents, the weights chosen by event are used in addition to those chosen by unevenness. With
/// kRefined, refined models are used.
template <class Effort, class Coder>
class RangePart {
 public:
  /// The state of a row after the pixels that are already coded.
  struct Row {
    std::array<std::int32_t, 3> west{};  // the last returns, newest first
    std::int32_t residual_west = 0;
    std::int32_t residual_west2 = 0;
    std::int32_t residual_north_west = 0;
    std::int32_t gap = 0;  // pixels since the last return
    std::int32_t zero_run = 0;
    std::int32_t other = kUnknown;      // value to the left of the last jump
    std::int32_t other2 = kUnknown;     // value to the left of the jump before the last
    std::int32_t latest = CentreOf(0);  // the newest return of the slice
  };

  /// `step_mm` is the width of a bin.
  RangePart(Model* model, Coder* coder, std::int64_t step_mm)
      : jump_(model, coder), model_(*model), coder_(*coder), step_mm_(step_mm) {}

  /// Begins a row. `above[i]` is the azimuth of pixel i. `north[i]` is the value of the nearest
  /// return above pixel i, or kUnknown if the rows above have no return.
  void StartRow(const Azimuth* above, const std::int32_t* north) {
    above_ = above;
    north_ = north;
    blind_ = north[0] == kUnknown;
    const std::int32_t latest = row_.latest;
    row_ = {};
    row_.residual_north_west = above[-1].residual;
    row_.latest = latest;
  }
  /// Returns the range class of the return before pixel `i`. If the row has none yet, returns the
  /// class of the value above pixel `i`.
  std::uint32_t NearClass(std::uint32_t i) const {
    return RangeClass(row_.west[0] != kUnknown ? row_.west[0] : north_[i]);
  }
  /// Notes that pixel `i` has no return.
  void Skip(std::uint32_t i) {
    ++row_.gap;
    row_.residual_north_west = above_[i].residual;
  }
  /// Codes the bin of pixel `i`, stores its value in `azimuth` and returns the bin. Returns -1 if
  /// the stream is damaged.
  [[gnu::always_inline]] std::int32_t Code(std::int32_t bin, std::uint32_t i, Azimuth* azimuth) {
    Look(i);
    SetContexts(i);
    const std::int32_t base = median_ >> 4;
    const std::int32_t difference = CodeDifference(mirror_ * (bin - base));
    bin = base + mirror_ * difference;
    if (bin < 0 || bin >= kMaxBins) return -1;
    for (unsigned k = 0; k < kUsedCentres; ++k)
      centres_[k].Learn((CentreOf(bin) - median_) * mirror_);
    Keep(CentreOf(bin), difference, azimuth);
    return bin;
  }
  /// Returns the surroundings of pixel `i`, for a caller that codes the pixel without Code().
  Surroundings SurroundingsOf(std::uint32_t i) {
    Look(i);
    return {w_, n_, median_, uneven_, range_class_};
  }
  /// Stores the bin of the pixel that SurroundingsOf() or Consider() selected, as Code() would do.
  void See(std::int32_t bin, Azimuth* azimuth) {
    Keep(CentreOf(bin), mirror_ * (bin - (median_ >> 4)), azimuth);
  }

  /// The following functions are for a search, which tries out bins with a CostMeter. Resume()
  /// returns to a state that row() returned before.
  const Row& row() const { return row_; }
  void Resume(const Row& row) { row_ = row; }
  /// Selects pixel `i`. CostOf() then returns the costs of its bins. Resume() and See() do not
  /// change these costs.
  void Consider(std::uint32_t i) {
    Look(i);
    SetContexts(i);
    asked_ = 0;
  }
  std::int32_t Predicted() const { return median_ >> 4; }
  /// Returns the cost of `bin`. If the cost is above `most`, the result may be too low, but is
  /// above `most`, too.
  std::int32_t CostOf(std::int32_t bin, std::int64_t most) {
    const std::int32_t difference = mirror_ * (bin - Predicted());
    CodeNode(difference != 0, 0);
    if (difference != 0 && coder_.cost() <= most) CodeSome(difference);
    return coder_.Take();
  }

 private:
  static constexpr unsigned kContexts = Effort::kRangeContexts;
  static constexpr unsigned kUsedCentres = Effort::kCentres;

  std::uint32_t RangeClass(std::int32_t value) const { return mixing::RangeClass(value, step_mm_); }

  /// Sets the neighbours and the prediction of pixel `i`.
  [[gnu::always_inline]] void Look(std::uint32_t i) {
    const Azimuth& at = above_[i];
    if (blind_) {
      n_ = nw_ = ne_ = nee_ = row_.west[0] != kUnknown ? row_.west[0] : row_.latest;
    } else {
      n_ = north_[i];
      nw_ = *(north_ + i - 1);
      ne_ = north_[i + 1];
      nee_ = north_[i + 2];
    }
    w_ = row_.west[0] != kUnknown ? row_.west[0] : n_;
    if (row_.west[0] == kUnknown) nw_ = n_;
    ww_ = row_.west[1] != kUnknown ? row_.west[1] : w_;
    www_ = row_.west[2] != kUnknown ? row_.west[2] : ww_;
    nn_ = at.values[1] != kUnknown ? at.values[1] : n_;
    other_ = row_.other;
    gradient_ = w_ + n_ - nw_;
    median_ = Median(w_, n_, nw_);
    mirror_ = n_ < w_ ? -1 : 1;
    const std::int32_t uneven = std::abs(w_ - n_) + std::abs(n_ - nw_);
    const std::int32_t rest = std::abs(ne_ - n_);
    const std::int32_t errors = std::abs(row_.residual_west) + std::abs(at.residual);
    uneven_ = UnevenClass(static_cast<std::uint32_t>(uneven) + static_cast<std::uint32_t>(rest) +
                          static_cast<std::uint32_t>(2 * kStep * errors));
    event_ = w_ == n_ ? 3 : median_ == w_ ? 1 : median_ == n_ ? 2 : 0;
    gap_class_ = row_.gap == 0 ? 0 : row_.gap < 3 ? 1 : row_.gap < 8 ? 2 : 3;
    range_class_ = RangeClass(median_);
  }

  std::uint32_t Offset(std::int32_t value) const {
    return OffsetClass((value - median_) * mirror_);
  }
  std::uint32_t Near(std::int32_t difference) const { return StepClass(difference * mirror_); }
  static std::uint32_t Size(std::int32_t residual) {
    return static_cast<std::uint32_t>(std::abs(residual));
  }
  std::uint32_t Residual(std::int32_t residual) const { return ResidualClass(residual, mirror_); }

  [[gnu::always_inline]] void SetContexts(std::uint32_t i) {
    const Azimuth& at = above_[i];
    const std::uint32_t coarse = uneven_ / 3;
    const auto north_error = static_cast<std::uint32_t>(std::abs(std::int32_t{at.residual}));
    const auto to_east = static_cast<std::uint32_t>(std::min(std::abs(ne_ - n_) / (kStep / 2), 3));
    const std::int64_t mean = (std::int64_t{w_} + n_ + ne_ + gradient_) >> 2;
    const auto phase = static_cast<std::int32_t>(
        std::clamp<std::int64_t>((mean - median_) * mirror_, -kStep * 4, kStep * 4));
    const std::int32_t up = at.values[1] != kUnknown ? Extrapolate(n_, nn_) : n_;
    const std::int32_t left = row_.west[1] != kUnknown ? Extrapolate(w_, ww_) : w_;
    const auto zeros = static_cast<std::uint32_t>(std::min(row_.zero_run, 7));
    const std::uint32_t east_residual = Residual(above_[i + 1].residual);
    const std::array<std::uint32_t, mixing::kRangeContexts.size()> values = {
        (Offset(ne_) * 11 + Offset(nn_)) * 11 + Offset(ww_),
        ((Residual(row_.residual_west) * 7 + Residual(at.residual)) * 7 + east_residual) * 4 +
            event_,
        (OffsetClass((nee_ - ne_) * mirror_) * 11 + OffsetClass((ne_ - n_) * mirror_)) * 4 + event_,
        ((event_ * 8 + zeros) * 4 + north_error) * 4 + to_east,
        ((Residual(row_.residual_west2) * 7 + Residual(row_.residual_west)) * 7 +
         Residual(row_.residual_north_west)) *
                4 +
            event_,
        ((Offset(up) * 11 + Offset(left)) * 4 + uneven_ / 6) * 4 + event_,
        OffsetClass((w_ - nw_) * mirror_) * 11 + OffsetClass((n_ - nw_) * mirror_),
        PhaseClass(phase) * 8 + coarse,
        (range_class_ * 4 + gap_class_) * 8 + coarse,
        uneven_,
        ((Near(w_ - nw_) * 7 + Near(n_ - nw_)) * 7 + Near(ne_ - n_)) * 7 + Near(ww_ - w_),
        (((Size(row_.residual_west) * 4 + Size(at.residual)) * 4 + Size(above_[i + 1].residual)) *
             4 +
         Size(row_.residual_north_west)) *
                4 +
            Size(row_.residual_west2),
        (Offset(other_ != kUnknown ? other_ : ne_) * 11 +
         Offset(at.values[2] != kUnknown ? at.values[2] : nn_)) *
                4 +
            event_};
    std::uint32_t base = 0;
    for (unsigned k = 0; k < kContexts; ++k) {
      rows_[k] = &model_.counters.range[kSmallNodes * (base + values[k])];
      base += mixing::kRangeContexts[k];
    }
    index_ = i;
    phase_ = PhaseClass(phase);
    event_set_ = event_ * 16 + static_cast<std::uint32_t>(std::min(row_.zero_run, 15));
    const std::size_t spread = uneven_ * 2 + (row_.gap > 0 ? 1 : 0);
    if constexpr (kUsedCentres > 0) {
      centres_[0].Set((w_ - median_) * mirror_, &model_.counters.spread[spread]);
      centres_[1].Set((n_ - median_) * mirror_,
                      &model_.counters.spread[2 * kUnevenClasses + spread]);
    }
  }

  using Mixer = BitMixer<kContexts, kUsedCentres>;
  [[gnu::always_inline]] void Ask(unsigned node, Mixer* mixer) {
    mixer->Ask(
        [&](unsigned k) __attribute__((always_inline)) { return rows_[k] + node; },
        [&](unsigned k) __attribute__((always_inline)) { return centres_[k].Opinion(node); });
  }
  Weights* WeightsOf(unsigned node) {
    return &model_.weights.range[node * kUnevenClasses + uneven_];
  }
  Weights* EventWeightsOf(unsigned node) { return &model_.weights.event[node * 64 + event_set_]; }
  /// Returns the sets of weights that refined models use for `node`.
  std::array<Weights*, 3> SetsOf(unsigned node) {
    const std::uint32_t set = range_class_ * 4 + gap_class_;
    return {WeightsOf(node), EventWeightsOf(node),
            &model_.refinement.ranges[node * Refinement::kRangeSets + set]};
  }
  ChanceMap* MapOf(unsigned node) { return &model_.refinement.maps[node * kMeanPhases + phase_]; }

  [[gnu::always_inline]] bool CodeNode(bool bit, unsigned node) {
    if constexpr (!kTeaches<Coder>) {
      return coder_.Code(bit, ChanceOf(node));
    } else {
      Mixer mixer;
      Ask(node, &mixer);
      if constexpr (Effort::kRefined)
        return mixer.CodeFast(bit, SetsOf(node), MapOf(node), &coder_);
      if constexpr (!Effort::kEvents) return mixer.Code(bit, WeightsOf(node), &coder_);
      return mixer.Code(bit, WeightsOf(node), EventWeightsOf(node), &coder_);
    }
  }
  /// Returns the chance for `node`. It is computed only once for all bins that are tried. The first
  /// calls for the nodes of a sign must be in ascending order, as Centre::Opinion() requires.
  std::int32_t ChanceOf(unsigned node) {
    if ((asked_ >> node & 1) != 0) return chances_[node];
    asked_ |= 1U << node;
    Mixer mixer;
    Ask(node, &mixer);
    if constexpr (Effort::kRefined)
      return chances_[node] = mixer.FastChanceBy(SetsOf(node), *MapOf(node));
    return chances_[node] = mixer.ChanceBy(WeightsOf(node), EventWeightsOf(node));
  }

  [[gnu::always_inline]] std::int32_t CodeDifference(std::int32_t difference) {
    return CodeNode(difference != 0, 0) ? CodeSome(difference) : 0;
  }
  /// Codes a difference that is not 0.
  [[gnu::always_inline]] std::int32_t CodeSome(std::int32_t difference) {
    const bool negative = CodeNode(difference < 0, 1);
    const std::int32_t sign = negative ? 1 : 0;
    const std::int32_t size = std::abs(difference);
    std::int32_t coded = 1;
    while (coded < 4 && CodeNode(size > coded, static_cast<unsigned>(2 * coded + sign))) ++coded;
    if (coded == 4) {
      const auto rest = static_cast<std::uint32_t>(std::max(size - 3, 1));
      coded = 3 + static_cast<std::int32_t>(jump_.Code(rest, ContextOfJump(negative)));
    }
    return (coded ^ -sign) + sign;
  }

  JumpContext ContextOfJump(bool negative) const {
    JumpContext c;
    const bool towards_sensor = negative != (mirror_ < 0);
    c.uneven = uneven_;
    c.range_class = (towards_sensor ? 16 : 0) + range_class_;
    const auto apart = static_cast<std::uint32_t>(std::abs(w_ - n_)) / kStep;
    c.gap_class = gap_class_ * 4 + static_cast<std::uint32_t>(std::min(BitLength(apart) / 2, 3));
    const std::int32_t base = median_ >> 4;
    const std::int32_t sense = negative ? -mirror_ : mirror_;
    const std::array<std::int32_t, kCandidates> values = {w_,  n_,   nw_,  ne_,   nn_,
                                                          ww_, www_, nee_, other_};
    for (unsigned k = 0; k < kCandidates; ++k)
      c.candidates[k] = ((values[k] >> 4) - base) * sense - 3;
    if constexpr (Effort::kRefined) {
      const std::array<std::int32_t, Refinement::kFurther> further = {
          row_.other2 != kUnknown ? row_.other2 : w_, blind_ ? n_ : north_[index_ + 3],
          blind_ ? n_ : north_[index_ + 5]};
      for (unsigned k = 0; k < Refinement::kFurther; ++k)
        c.further[k] = ((further[k] >> 4) - base) * sense - 3;
    }
    return c;
  }

  void Keep(std::int32_t value, std::int32_t difference, Azimuth* azimuth) {
    if (std::abs(difference) > 3) {
      row_.other2 = row_.other;
      row_.other = w_;
    }
    const std::int32_t residual = std::clamp(difference, -3, 3) * mirror_;
    row_.residual_west2 = row_.residual_west;
    row_.residual_west = residual;
    row_.residual_north_west = azimuth->residual;
    azimuth->residual = static_cast<std::int8_t>(residual);
    azimuth->values = {value, azimuth->values[0], azimuth->values[1]};
    row_.west = {value, row_.west[0], row_.west[1]};
    row_.latest = value;
    row_.zero_run = difference == 0 ? row_.zero_run + 1 : 0;
    row_.gap = 0;
  }

  JumpPart<Effort::kCandidates, Coder, Effort::kRefined> jump_;
  Model& model_;
  Coder& coder_;
  std::int64_t step_mm_;

  // These members are set for each row.
  const Azimuth* above_ = nullptr;
  const std::int32_t* north_ = nullptr;
  bool blind_ = false;
  Row row_;

  // These members are set for each return.
  std::uint32_t index_ = 0;
  std::uint32_t phase_ = 0;  // class of the neighbours' mean
  std::int32_t n_ = 0, nw_ = 0, ne_ = 0, nee_ = 0, nn_ = 0, w_ = 0, ww_ = 0, www_ = 0;
  std::int32_t other_ = kUnknown;
  std::int32_t gradient_ = 0;
  std::int32_t median_ = 0;
  std::int32_t mirror_ = 1;
  std::uint32_t uneven_ = 0;
  std::uint32_t event_ = 0;
  std::uint32_t gap_class_ = 0;
  std::uint32_t range_class_ = 0;
  std::uint32_t event_set_ = 0;
  std::array<Counter*, kContexts> rows_{};  // counter of node 0 in each context
  std::array<Centre, kCentres> centres_;
  std::uint32_t asked_ = 0;  // bit k: chances_[k] is known
  std::array<std::int32_t, kSmallNodes> chances_{};
};

}  // namespace lidar::codec::mixing
