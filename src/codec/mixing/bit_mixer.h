// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes one bit with a mix of counters and other opinions, and lets all of them learn from it.
#pragma once
#include <array>
#include <cstdint>

#include "src/codec/mixing/arithmetic.h"
#include "src/codec/mixing/cost_meter.h"
#include "src/codec/mixing/mixer.h"

namespace lidar::codec::mixing {

/// For decisions that have kCounters counters and kExtra other logits: inputs of one place always
/// mean the same.
template <unsigned kCounters, unsigned kExtra>
class BitMixer {
 public:
  static_assert(kCounters + kExtra < kInputs);
  explicit BitMixer(const Kernel& kernel) : kernel_(kernel) {}

  /// `counter_at(0 .. kCounters - 1)` are the counters of the next bit, `logit_at` gives the rest.
  template <class CounterAt, class LogitAt>
  void Ask(CounterAt&& counter_at, LogitAt&& logit_at) {
    inputs_.packed[0] = Word<0>(counter_at, logit_at);
    inputs_.packed[1] = Word<1>(counter_at, logit_at);
    inputs_.packed[2] = Word<2>(counter_at, logit_at);
    inputs_.packed[3] = Word<3>(counter_at, logit_at);
  }
  template <class CounterAt>
  void Ask(CounterAt&& counter_at) {
    static_assert(kExtra == 0);
    Ask(counter_at, [](unsigned) { return 0; });
  }

  template <class Coder>
  bool Code(bool bit, Weights* weights, Coder* coder) {
    const auto& [a, b, c, d] = inputs_.packed;
    const std::int32_t chance = Chance(kernel_.dot(a, b, c, d, weights) >> kDotShift);
    bit = coder->Code(bit, chance);
    if constexpr (!kTeaches<Coder>) return bit;
    kernel_.learn(a, b, c, d, StepOf(bit, chance), weights);
    Learn(bit);
    return bit;
  }
  /// With two sets of weights, each of which learns from what it would have said alone.
  template <class Coder>
  bool Code(bool bit, Weights* first, Weights* second, Coder* coder) {
    static_assert(kTeaches<Coder>);
    const auto& [a, b, c, d] = inputs_.packed;
    const Sums sums = kernel_.dots(a, b, c, d, first, second);
    const std::int32_t one = ClampLogit(sums.first >> kDotShift);
    const std::int32_t other = ClampLogit(sums.second >> kDotShift);
    bit = coder->Code(bit, Chance((one + other) >> 1));
    kernel_.learn(a, b, c, d, StepOf(bit, Chance(one)), first);
    kernel_.learn(a, b, c, d, StepOf(bit, Chance(other)), second);
    Learn(bit);
    return bit;
  }
  /// What Code() would take for the chance of a 1.
  std::int32_t ChanceBy(const Weights* first, const Weights* second) const {
    const auto& [a, b, c, d] = inputs_.packed;
    const Sums sums = kernel_.dots(a, b, c, d, first, second);
    return Chance((ClampLogit(sums.first >> kDotShift) + ClampLogit(sums.second >> kDotShift)) >>
                  1);
  }

 private:
  static constexpr unsigned kDotShift = 12;

  /// Four inputs. They are put together in a register: a vector that is loaded from where single
  /// numbers were just stored makes processors wait.
  template <unsigned kPlace, class CounterAt, class LogitAt>
  Kernel::Four Word(CounterAt& counter_at, LogitAt& logit_at) {
    constexpr std::int32_t kAlways = 256;
    Kernel::Four word = 0;
#pragma GCC unroll 4
    for (unsigned i = 4 * kPlace; i < 4 * kPlace + 4; ++i) {
      std::int32_t logit = i == kInputs - 1 ? kAlways : 0;
      if (i < kCounters) {
        counters_[i] = counter_at(i);
        logit = counters_[i]->Vote();
      } else if (i < kCounters + kExtra) {
        logit = ClampLogit(logit_at(i - kCounters));
      }
      word |= Inputs::Packed(i, logit);
    }
    return word;
  }

  void Learn(bool bit) {
#pragma GCC unroll 16
    for (unsigned i = 0; i < kCounters; ++i) counters_[i]->Learn(bit);
  }

  const Kernel& kernel_;
  Inputs inputs_;
  std::array<Counter*, kCounters> counters_{};
};

}  // namespace lidar::codec::mixing
