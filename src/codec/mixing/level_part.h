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

/// A return next to the one that is coded.
struct LevelAt {
  std::int32_t bin = -1;  // -1: none is known
  std::int32_t level = 0;
  std::int32_t residual = 0;  // -3 to 3
};

template <class Coder>
class LevelPart {
 public:
  LevelPart(const Kernel& kernel, LevelModel* model, Coder* coder, unsigned bits)
      : mixer_(kernel), model_(*model), coder_(*coder), most_((1 << bits) - 1) {}

  struct Around {
    std::int32_t bin;  // of the return itself
    LevelAt w, ww, n, nw, ne, nn;
  };

  /// Returns the level, and in `residual` what it differs from its prediction; -1 for a damaged
  /// stream.
  std::int32_t Code(std::int32_t level, const Around& around, std::int32_t* residual) {
    Look(around);
    const std::int32_t difference = CodeDifference(mirror_ * (level - predicted_));
    *residual = std::clamp(difference, -3, 3) * mirror_;
    level = predicted_ + mirror_ * difference;
    return level >= 0 && level <= most_ ? level : -1;
  }

 private:
  /// 2: as far away as the return, 1: not quite, 0: on another surface, or none.
  static std::uint32_t Closeness(const LevelAt& at, std::int32_t bin) {
    if (at.bin < 0) return 0;
    const std::int32_t apart = std::abs(at.bin - bin);
    return apart <= 2 ? 2 : apart <= 8 ? 1 : 0;
  }

  void Look(const Around& a) {
    const std::uint32_t west = Closeness(a.w, a.bin);
    const std::uint32_t north = Closeness(a.n, a.bin);
    const std::uint32_t north_east = Closeness(a.ne, a.bin);
    const std::int32_t n = a.n.bin >= 0 ? a.n.level : a.w.level;
    const std::int32_t w = a.w.bin >= 0 ? a.w.level : n;
    const std::int32_t nw = a.nw.bin >= 0 ? a.nw.level : n;
    const std::int32_t ne = a.ne.bin >= 0 ? a.ne.level : n;
    if (west == north) {
      predicted_ = Median(w, n, nw);
    } else {
      predicted_ = west > north ? w : n;
    }
    mirror_ = n < w ? -1 : 1;
    const std::int32_t sum = std::abs(w - n) + std::abs(n - nw) + std::abs(ne - n) +
                             2 * (std::abs(a.w.residual) + std::abs(a.n.residual));
    uneven_ = std::min(HalfOctave(static_cast<std::uint32_t>(2 * sum)), kUnevenClasses - 1);
    const auto offset = [&](const LevelAt& at) {
      return at.bin < 0 ? 5U : OffsetClass((at.level - predicted_) * mirror_ * kStep);
    };
    const auto narrow = [&](std::int32_t value) {
      return static_cast<std::uint32_t>(std::clamp((value - predicted_) * mirror_, -7, 7) + 7);
    };
    const auto residual = [&](const LevelAt& at) { return ResidualClass(at.residual, mirror_); };
    surfaces_ = (west * 3 + north) * 3 + north_east;
    const auto height = static_cast<std::uint32_t>(predicted_ * 16 / (most_ + 1));
    const std::array<std::uint32_t, kLevelContexts.size()> values = {
        uneven_,
        narrow(w) * 15 + narrow(n),
        (residual(a.w) * 7 + residual(a.n)) * 7 + residual(a.ne),
        surfaces_ * 36 + std::min(uneven_, 17U) * 2 + (w == n ? 1U : 0U),
        height * 32 + std::min(uneven_, 15U) * 2 + (mirror_ < 0 ? 1U : 0U),
        (offset(a.ne) * 11 + offset(a.nn)) * 11 + offset(a.ww)};
    std::uint32_t base = 0;
    for (unsigned k = 0; k < values.size(); ++k) {
      contexts_[k] = kSmallNodes * (base + values[k]);
      base += kLevelContexts[k];
    }
  }

  bool CodeNode(bool bit, unsigned node) {
    mixer_.Ask([&](unsigned k) { return &model_.counters[contexts_[k] + node]; });
    return mixer_.Code(bit, &model_.weights[node * kUnevenClasses + uneven_],
                       &model_.surface_weights[node * kSurfaces + surfaces_], &coder_);
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

  /// 1 to 255, as a binary tree behind its length.
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
    Counter& counter = model_.rest[node];
    bit = coder_.Code(bit, std::clamp<std::int32_t>(counter.chance, kLeastChance, kMostChance));
    counter.Learn(bit);
    return bit;
  }

  BitMixer<kLevelContexts.size(), 0> mixer_;
  LevelModel& model_;
  Coder& coder_;
  std::int32_t most_;
  std::int32_t predicted_ = 0;
  std::int32_t mirror_ = 1;
  std::uint32_t uneven_ = 0;
  std::uint32_t surfaces_ = 0;
  std::array<std::uint32_t, kLevelContexts.size()> contexts_{};
};

}  // namespace lidar::codec::mixing
