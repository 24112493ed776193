// SPDX-License-Identifier: LGPL-2.1-or-later
// Logistic mixing. The chance of a bit is computed from the weighted sum of logits: the votes of
// counters, and other logits. Weights and counters then learn from the bit.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "src/codec/mixing/arithmetic.h"
#include "src/codec/mixing/cost_meter.h"
#include "src/codec/mixing/lanes.h"

namespace lidar::codec::mixing {

constexpr unsigned kInputs = 2 * kLanes;

/// A set of weights, one for each input of a decision, in 1/kWeightOne.
struct alignas(32) Weights {
  std::array<std::int16_t, kInputs> values{};
};
constexpr unsigned kWeightShift = 13;
constexpr std::int32_t kWeightOne = 1 << kWeightShift;

/// Returns the step by which weights learn from the error `bit - chance`. It fits an int16.
inline std::int32_t StepOf(bool bit, std::int32_t chance) {
  constexpr std::int32_t kSpeed = 5;
  return ((bit ? kOne : 0) - chance) * kSpeed >> 4;
}

/// Returns the step for refined models. Their weights learn faster: BitMixer::CodeFast() also
/// doubles the inputs.
inline std::int32_t FastStepOf(bool bit, std::int32_t chance) {
  constexpr std::int32_t kSpeed = 6;
  return ((bit ? kOne : 0) - chance) * kSpeed >> 4;
}

/// Maps a logit to the share of 1s among the earlier bits that had about this logit.
class ChanceMap {
 public:
  ChanceMap() {
    for (std::int32_t i = 0; i < kEntries; ++i)
      chances_[static_cast<std::size_t>(i)] =
          static_cast<std::uint16_t>(Chance((i << kShift) - kMiddle));
  }
  /// Returns the mean of two chances: the chance that `logit` stands for, and the share of 1s among
  /// the earlier bits with about this logit.
  std::int32_t Refined(std::int32_t logit) const {
    const std::int32_t place = ClampLogit(logit) + kMiddle;
    const auto i = static_cast<std::size_t>(place >> kShift);
    const std::int32_t part = place & kPart;
    const std::int32_t been = (chances_[i] * (kPart + 1 - part) + chances_[i + 1] * part) >> kShift;
    return std::clamp((Chance(logit) + been) >> 1, kLeastChance, kMostChance);
  }
  /// Updates the map after a bit that was coded with `logit`.
  void Learn(std::int32_t logit, bool bit) {
    const std::int32_t place = ClampLogit(logit) + kMiddle + kPart / 2 + 1;
    std::uint16_t& chance = chances_[static_cast<std::size_t>(place >> kShift)];
    chance = static_cast<std::uint16_t>(chance + (((bit ? kOne - 1 : 0) - chance) >> kRateShift));
  }

 private:
  static constexpr unsigned kShift = 7;
  static constexpr unsigned kRateShift = 6;
  static constexpr std::int32_t kPart = (1 << kShift) - 1;
  static constexpr std::int32_t kMiddle = 2'048;
  static constexpr std::int32_t kEntries = 33;
  std::array<std::uint16_t, kEntries> chances_{};
};

/// Codes a decision: a bit that is predicted by kCounters counters and kExtra other logits. The
/// last input of the mixer is a constant.
///
/// A mixer is made for each decision anew and is inlined, so that counters, votes and sums stay in
/// registers. With calls instead, efforts 2 and 3 would take 1.3 times as long.
template <unsigned kCounters, unsigned kExtra, class Lanes = FastLanes>
class BitMixer {
 public:
  static_assert(kCounters + kExtra < kInputs);

  /// Collects the inputs for the next bit. `counter_at(i)` returns counter i, for i from 0 to
  /// kCounters - 1. These must be different counters. `logit_at(i)` returns the other logit i.
  template <class CounterAt, class LogitAt>
  [[gnu::always_inline]] void Ask(CounterAt&& counter_at, LogitAt&& logit_at) {
    AskEight<0>(counter_at, logit_at);
    if constexpr (kEights > 1) AskEight<1>(counter_at, logit_at);
  }
  template <class CounterAt>
  [[gnu::always_inline]] void Ask(CounterAt&& counter_at) {
    static_assert(kExtra == 0);
    Ask(counter_at, NoLogit);
  }

  template <class Coder>
  [[gnu::always_inline]] bool Code(bool bit, Weights* weights, Coder* coder) {
    const std::int32_t chance = Chance(LogitBy(*weights));
    bit = coder->Code(bit, chance);
    if constexpr (!kTeaches<Coder>) return bit;
    Teach(StepOf(bit, chance), weights);
    Learn(bit);
    return bit;
  }
  /// Codes a bit by two sets of weights: the mean of their logits predicts the bit. Each set then
  /// learns from the error that it would have made alone.
  template <class Coder>
  [[gnu::always_inline]] bool Code(bool bit, Weights* first, Weights* second, Coder* coder) {
    static_assert(kTeaches<Coder>);
    const std::int32_t one = LogitBy(*first);
    const std::int32_t other = LogitBy(*second);
    bit = coder->Code(bit, Chance((one + other) >> 1));
    Teach(StepOf(bit, Chance(one)), first);
    Teach(StepOf(bit, Chance(other)), second);
    Learn(bit);
    return bit;
  }
  /// Returns the chance of a 1 that Code() would use with these two sets.
  [[gnu::always_inline]] std::int32_t ChanceBy(const Weights* first, const Weights* second) const {
    return Chance((LogitBy(*first) + LogitBy(*second)) >> 1);
  }

  /// Codes a bit by the mean logit of several sets of weights. These learn faster than in Code().
  /// If `map` is not null, it refines the chance.
  template <std::size_t kSets, class Coder>
  [[gnu::always_inline]] bool CodeFast(bool bit, const std::array<Weights*, kSets>& sets,
                                       ChanceMap* map, Coder* coder) {
    std::array<std::int32_t, kSets> logits;
    for (std::size_t i = 0; i < kSets; ++i) logits[i] = LogitBy(*sets[i]);
    const std::int32_t mean = MeanOf(logits);
    bit = coder->Code(bit, map != nullptr ? map->Refined(mean) : Chance(mean));
    if constexpr (!kTeaches<Coder>) return bit;
    if (map != nullptr) map->Learn(mean, bit);
    for (std::size_t i = 0; i < kSets; ++i) {
      const std::int32_t step = FastStepOf(bit, Chance(logits[i]));
      for (unsigned k = 0; k < kEights; ++k)
        Lanes::Teach(Lanes::Twice(inputs_[k]), step, sets[i]->values.data() + k * kLanes);
    }
    Learn(bit);
    return bit;
  }
  /// Returns the chance of a 1 that CodeFast() would use with these sets and this map.
  template <std::size_t kSets>
  [[gnu::always_inline]] std::int32_t FastChanceBy(const std::array<Weights*, kSets>& sets,
                                                   const ChanceMap& map) const {
    std::array<std::int32_t, kSets> logits;
    for (std::size_t i = 0; i < kSets; ++i) logits[i] = LogitBy(*sets[i]);
    return map.Refined(MeanOf(logits));
  }

 private:
  using Numbers = std::array<std::int16_t, kLanes>;
  static std::int32_t NoLogit(unsigned /*place*/) { return 0; }
  template <std::size_t kSets>
  static std::int32_t MeanOf(const std::array<std::int32_t, kSets>& logits) {
    std::int32_t sum = 0;
    for (const std::int32_t logit : logits) sum += logit;
    return sum / static_cast<std::int32_t>(kSets);
  }
  static constexpr unsigned kEights = kCounters + kExtra < kLanes ? 1 : 2;
  static constexpr std::int16_t kAlways = 256;

  static constexpr unsigned CountersOf(unsigned eight) {
    return kCounters < eight * kLanes ? 0 : std::min(kCounters - eight * kLanes, kLanes);
  }

  template <unsigned kEight, class CounterAt, class LogitAt>
  [[gnu::always_inline]] void AskEight(CounterAt& counter_at, LogitAt& logit_at) {
    constexpr unsigned kFirst = kEight * kLanes;
    constexpr unsigned kCount = CountersOf(kEight);
    Numbers logits{};
    Numbers rest{};
#pragma GCC unroll 8
    for (unsigned i = 0; i < kLanes; ++i) {
      if (i < kCount) {
        counters_[kFirst + i] = counter_at(kFirst + i);
        logits[i] = static_cast<std::int16_t>(Logit(counters_[kFirst + i]->chance));
      } else if (kFirst + i < kCounters + kExtra) {
        rest[i] = static_cast<std::int16_t>(ClampLogit(logit_at(kFirst + i - kCounters)));
      }
    }
    if (kEight + 1 == kEights) rest[kLanes - 1] = kAlways;
    if constexpr (kCount == 0) {
      inputs_[kEight] = Lanes::Of(rest);
    } else {
      known_[kEight] = Lanes::template Load<kCount>(&counters_[kFirst]);
      inputs_[kEight] = Lanes::Votes(Lanes::Of(logits), known_[kEight]);
      if constexpr (kCount < kLanes)
        inputs_[kEight] = Lanes::Join(inputs_[kEight], Lanes::Of(rest));
    }
  }

  [[gnu::always_inline]] std::int32_t LogitBy(const Weights& weights) const {
    typename Lanes::Sum sum = Lanes::Dot(inputs_[0], weights.values.data());
    if constexpr (kEights > 1)
      sum = Lanes::Plus(sum, Lanes::Dot(inputs_[1], weights.values.data() + kLanes));
    return ClampLogit(Lanes::Total(sum) >> kWeightShift);
  }
  [[gnu::always_inline]] void Teach(std::int32_t step, Weights* weights) {
    for (unsigned i = 0; i < kEights; ++i)
      Lanes::Teach(inputs_[i], step, weights->values.data() + i * kLanes);
  }
  [[gnu::always_inline]] void Learn(bool bit) {
    LearnEight<0>(bit);
    if constexpr (kEights > 1) LearnEight<1>(bit);
  }
  template <unsigned kEight>
  [[gnu::always_inline]] void LearnEight(bool bit) {
    constexpr unsigned kCount = CountersOf(kEight);
    if constexpr (kCount > 0)
      Lanes::template Store<kCount>(Lanes::Learnt(known_[kEight], bit),
                                    &counters_[kEight * kLanes]);
  }

  typename Lanes::Eight inputs_[kEights];
  typename Lanes::Counters known_[kEights];
  std::array<Counter*, kCounters> counters_{};
};

}  // namespace lidar::codec::mixing
