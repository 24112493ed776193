// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes the intensity level of a return, once the ranges of the whole slice are known.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>

#include "src/codec/mixing/bit_mixer.h"
#include "src/codec/mixing/model.h"
#include "src/codec/mixing/neighbours.h"

namespace lidar::codec::mixing {

/// A neighbour of the return whose level is coded.
struct LevelAt {
  std::int32_t bin = -1;  // -1: the neighbour has no return
  std::int32_t level = 0;
  std::int32_t residual = 0;  // -3 to 3
};

/// Codes levels. Uses the first kContexts of the contexts in SetContexts().
template <unsigned kContexts, class Coder>
class LevelPart {
 public:
  LevelPart(Model* model, Coder* coder, unsigned bits, std::int64_t step_mm)
      : counters_(model->level_counters),
        weights_(model->level_weights),
        coder_(*coder),
        most_((1 << bits) - 1),
        step_mm_(step_mm) {}

  struct Around {
    std::int32_t bin;  // of the return whose level is coded
    LevelAt w, ww, n, nw, ne, nn;
  };

  void StartRow() { zero_run_ = 0; }
  /// Codes `level` and returns it, or returns -1 if the stream is damaged. Sets `residual` to the
  /// difference of the level from its prediction, limited to -3 to 3.
  std::int32_t Code(std::int32_t level, const Around& around, std::int32_t* residual) {
    Look(around);
    SetContexts(around);
    const std::int32_t difference = CodeDifference(mirror_ * (level - predicted_));
    zero_run_ = difference == 0 ? std::min(zero_run_ + 1, 15U) : 0;
    *residual = std::clamp(difference, -3, 3) * mirror_;
    level = predicted_ + mirror_ * difference;
    return level >= 0 && level <= most_ ? level : -1;
  }

 private:
  /// Returns how near the neighbour `at` is to `bin`: 2 if it is within 2 bins, 1 if within 8 bins.
  /// Returns 0 if it is farther away, and thus on another surface, or has no return.
  static std::uint32_t Closeness(const LevelAt& at, std::int32_t bin) {
    if (at.bin < 0) return 0;
    const std::int32_t apart = std::abs(at.bin - bin);
    return apart <= 2 ? 2 : apart <= 8 ? 1 : 0;
  }

  void Look(const Around& a) {
    const std::uint32_t west = Closeness(a.w, a.bin);
    const std::uint32_t north = Closeness(a.n, a.bin);
    n_ = a.n.bin >= 0 ? a.n.level : a.w.level;
    w_ = a.w.bin >= 0 ? a.w.level : n_;
    nw_ = a.nw.bin >= 0 ? a.nw.level : n_;
    ne_ = a.ne.bin >= 0 ? a.ne.level : n_;
    if (west == north) {
      predicted_ = Median(w_, n_, nw_);
    } else {
      predicted_ = west > north ? w_ : n_;
    }
    mirror_ = n_ < w_ ? -1 : 1;
    const std::int32_t sum = std::abs(w_ - n_) + std::abs(n_ - nw_) + std::abs(ne_ - n_) +
                             2 * (std::abs(a.w.residual) + std::abs(a.n.residual));
    uneven_ = std::min(HalfOctave(static_cast<std::uint32_t>(2 * sum)), kUnevenClasses - 1);
    surfaces_ = (west * 3 + north) * 3 + Closeness(a.ne, a.bin);
    event_ = w_ == n_ ? 3 : predicted_ == w_ ? 1 : predicted_ == n_ ? 2 : 0;
  }

  std::uint32_t Offset(const LevelAt& at) const {
    return at.bin < 0 ? 5U : OffsetClass((at.level - predicted_) * mirror_ * kStep);
  }
  std::uint32_t Narrow(std::int32_t value) const {
    return static_cast<std::uint32_t>(std::clamp((value - predicted_) * mirror_, -7, 7) + 7);
  }
  std::uint32_t Residual(const LevelAt& at) const { return ResidualClass(at.residual, mirror_); }
  static std::uint32_t Size(const LevelAt& at) {
    return static_cast<std::uint32_t>(std::abs(at.residual));
  }
  /// Scales a level, which has any number of bits, to 0 to 31.
  std::uint32_t Height(std::int32_t level) const {
    return static_cast<std::uint32_t>(level * 32 / (most_ + 1));
  }
  /// Returns the class of the distance from the neighbour `at` to `bin`, which is negative if `bin`
  /// is nearer to the sensor.
  std::uint32_t Depth(const LevelAt& at, std::int32_t bin) const {
    return at.bin < 0 ? 3U : StepClass(std::clamp(bin - at.bin, -4, 4) * kStep);
  }

  /// The mean level of neighbours (`sum` / `count`), weighted by their closeness to the return.
  struct Weighed {
    std::int32_t sum = 0;
    std::int32_t count = 0;

    void Add(const LevelAt& at, std::int32_t bin, std::int32_t factor) {
      if (at.bin < 0) return;
      constexpr std::array<std::int32_t, 3> kCloseness = {1, 4, 8};
      const std::int32_t weight = factor * kCloseness[Closeness(at, bin)];
      sum += weight * at.level;
      count += weight;
    }
  };
  std::uint32_t Phase(const Weighed& mean) const {
    if (mean.count == 0) return PhaseClass(0);
    return PhaseClass((kStep * mean.sum / mean.count - kStep * predicted_) * mirror_);
  }

  void SetContexts(const Around& a) {
    Weighed row;
    row.Add(a.w, a.bin, 2);
    row.Add(a.ww, a.bin, 1);
    Weighed above;
    above.Add(a.n, a.bin, 2);
    above.Add(a.nw, a.bin, 1);
    above.Add(a.ne, a.bin, 1);
    above.Add(a.nn, a.bin, 1);
    const Weighed all{row.sum + above.sum, row.count + above.count};
    const std::uint32_t mirrored = mirror_ < 0 ? 1U : 0U;
    const std::array<std::uint32_t, kLevelContexts.size()> values = {
        uneven_,
        Narrow(w_) * 15 + Narrow(n_),
        (Residual(a.w) * 7 + Residual(a.n)) * 7 + Residual(a.ne),
        surfaces_ * 36 + std::min(uneven_, 17U) * 2 + (w_ == n_ ? 1U : 0U),
        Height(predicted_) / 2 * 32 + std::min(uneven_, 15U) * 2 + mirrored,
        (Offset(a.ne) * 11 + Offset(a.nn)) * 11 + Offset(a.ww),
        Height(w_) * 32 + Height(n_),
        (Height(predicted_) * 16 + RangeClass(CentreOf(a.bin), step_mm_)) * 2 + mirrored,
        Narrow(nw_) * 15 + Narrow(ne_),
        Phase(all) * 27 + surfaces_,
        (Depth(a.w, a.bin) * 7 + Depth(a.n, a.bin)) * 15 + Narrow(predicted_ == w_ ? n_ : w_),
        ((Residual(a.ww) * 7 + Residual(a.w)) * 7 + Residual(a.nw)) * 4 + event_,
        ((zero_run_ * 4 + Size(a.n)) * 4 + Size(a.ne)) * 4 + event_,
        Phase(row) * 15 + Phase(above)};
    std::uint32_t base = 0;
    for (unsigned k = 0; k < kContexts; ++k) {
      contexts_[k] = kSmallNodes * (base + values[k]);
      base += kLevelContexts[k];
    }
  }

  bool CodeNode(bool bit, unsigned node) {
    BitMixer<kContexts, 0> mixer;
    mixer.Ask([&](unsigned k)
                  __attribute__((always_inline)) { return &counters_.small[contexts_[k] + node]; });
    return mixer.Code(bit, &weights_.uneven[node * kUnevenClasses + uneven_],
                      &weights_.surfaces[node * kSurfaces + surfaces_], &coder_);
  }

  std::int32_t CodeDifference(std::int32_t difference) {
    if (!CodeNode(difference != 0, 0)) return 0;
    const bool negative = CodeNode(difference < 0, 1);
    const std::int32_t size = std::abs(difference);
    std::int32_t coded = 1;
    while (coded < 4 && CodeNode(size > coded, static_cast<unsigned>(2 * coded + negative)))
      ++coded;
    if (coded == 4) coded = 3 + CodeRest(std::max(size - 3, 1), negative);
    return negative ? -coded : coded;
  }

  /// Codes a number from 1 to 255: first its bit length, then its lower bits as a binary tree.
  std::int32_t CodeRest(std::int32_t rest, bool negative) {
    const int last = BitLength(static_cast<std::uint32_t>(rest)) - 1;
    int length = 0;
    while (length < 8 &&
           CodeAlone(length < last, static_cast<unsigned>(length) + (negative ? 16 : 0)))
      ++length;
    std::int32_t value = 1;
    for (int place = length; place-- > 0;)
      value = 2 * value + CodeAlone((rest >> place & 1) != 0,
                                    256 + std::min(static_cast<unsigned>(value), 255U));
    return value;
  }
  bool CodeAlone(bool bit, unsigned node) {
    Counter& counter = counters_.rest[node];
    bit = coder_.Code(bit, std::clamp<std::int32_t>(counter.chance, kLeastChance, kMostChance));
    counter.Learn(bit);
    return bit;
  }

  LevelCounters& counters_;
  LevelWeights& weights_;
  Coder& coder_;
  const std::int32_t most_;
  const std::int64_t step_mm_;
  std::uint32_t zero_run_ = 0;

  // These members are set for each return.
  std::int32_t n_ = 0, nw_ = 0, ne_ = 0, w_ = 0;
  std::int32_t predicted_ = 0;
  std::int32_t mirror_ = 1;
  std::uint32_t uneven_ = 0;
  std::uint32_t surfaces_ = 0;
  std::uint32_t event_ = 0;
  std::array<std::uint32_t, kContexts> contexts_{};
};

}  // namespace lidar::codec::mixing
