// SPDX-License-Identifier: LGPL-2.1-or-later
// An adaptive probability distribution over 16 symbols, updated with vector instructions.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#ifdef __SSE2__
#include <emmintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif

namespace lidar::codec {

constexpr unsigned kNibbles = 16;
constexpr unsigned kProbabilityBits = 15;
constexpr std::uint32_t kProbabilityOne = 1U << kProbabilityBits;

/// The interval of a symbol within 0 .. kProbabilityOne. Its size is the symbol's probability.
struct Interval {
  std::uint16_t start;
  std::uint16_t size;
};

namespace detail {

/// For each symbol, the starts of intervals towards which Update() moves a model. The starts up to
/// the symbol are low, the starts after it are high. Each start is larger than the one before, so
/// no interval becomes empty.
struct Targets {
  constexpr Targets() {
    for (unsigned symbol = 0; symbol < kNibbles; ++symbol)
      for (unsigned i = 0; i < kNibbles; ++i)
        starts[symbol][i] =
            static_cast<std::int16_t>(i + (i > symbol ? kProbabilityOne - kNibbles : 0));
  }
  alignas(16) std::int16_t starts[kNibbles][kNibbles] = {};
};
inline constexpr Targets kTargets;

/// The shift that sets the speed of learning, for each age of a model (number of updates). A young
/// model learns fastest, because the first few samples say the most about a context.
struct Rates {
  static constexpr unsigned kMiddleAge = 24;
  static constexpr unsigned kOldest = 400;
  constexpr Rates() {
    for (unsigned age = 0; age <= kOldest; ++age)
      rates[age] = static_cast<std::int8_t>(age < kMiddleAge ? 5 : age < kOldest ? 6 : 7);
  }
  std::int8_t rates[kOldest + 1] = {};
};
inline constexpr Rates kRates;

}  // namespace detail

class NibbleModel;
/// Four models. The mean of their distributions predicts a symbol.
using BlendedModels = std::array<NibbleModel*, 4>;
/// Blended models learn twice as fast as single models.
constexpr int kBlendedHaste = 1;

/// The cumulative distribution of symbols (F. Giesen, "Mixing discrete probability distributions",
/// 2015). An update moves it towards a distribution that has nearly all of its mass on the symbol
/// seen. No symbol gets the probability 0, because both the starts before an update and the starts
/// of this target are strictly increasing.
class NibbleModel {
 public:
  /// Makes all symbols equally probable.
  NibbleModel() : NibbleModel(UniformCounts()) {}
  /// Makes probabilities proportional to `counts`. A symbol with a count of 0 gets a small
  /// probability.
  explicit NibbleModel(const std::array<std::uint16_t, kNibbles>& counts) {
    std::uint32_t total = 0;
    for (const std::uint16_t c : counts) total += c;
    constexpr std::uint32_t kFree = kProbabilityOne - kNibbles * kFloor;
    std::uint32_t below = 0;
    for (unsigned i = 0; i < kNibbles; ++i) {
      start_[i] = static_cast<std::int16_t>(i * kFloor + kFree * below / total);
      below += counts[i];
    }
    start_[kNibbles] = static_cast<std::int16_t>(kProbabilityOne - 65536);
  }

  Interval IntervalOf(unsigned symbol) const {
    const auto start = static_cast<std::uint16_t>(start_[symbol]);
    const auto end = static_cast<std::uint16_t>(start_[symbol + 1]);
    return {start, static_cast<std::uint16_t>(end - start)};
  }

  /// Returns the symbol whose interval contains `slot`. `slot` must be less than kProbabilityOne.
  unsigned Find(std::uint32_t slot) const {
#ifdef __SSE2__
    const __m128i v = _mm_set1_epi16(static_cast<std::int16_t>(slot));
    const __m128i low = _mm_load_si128(reinterpret_cast<const __m128i*>(start_.data()));
    const __m128i high = _mm_load_si128(reinterpret_cast<const __m128i*>(start_.data() + 8));
    const int above =
        _mm_movemask_epi8(_mm_packs_epi16(_mm_cmpgt_epi16(low, v), _mm_cmpgt_epi16(high, v)));
    return static_cast<unsigned>(__builtin_ctz(static_cast<unsigned>(above) | 0x10000U)) - 1U;
#elif defined(__aarch64__)
    // The starts are in ascending order, so the number of starts that are <= `slot` is the symbol
    // plus 1. The comparison gives -1 (65535) for each of these starts.
    const int16x8_t v = vdupq_n_s16(static_cast<std::int16_t>(slot));
    const uint16x8_t up_to_slot = vaddq_u16(vcleq_s16(vld1q_s16(start_.data()), v),
                                            vcleq_s16(vld1q_s16(start_.data() + 8), v));
    return static_cast<std::uint16_t>(-vaddvq_u16(up_to_slot)) - 1U;
#elif defined(__wasm_simd128__)
    const v128_t v = wasm_i16x8_splat(static_cast<std::int16_t>(slot));
    const v128_t low = wasm_i16x8_gt(wasm_v128_load(start_.data()), v);
    const v128_t high = wasm_i16x8_gt(wasm_v128_load(start_.data() + 8), v);
    const std::uint32_t above = wasm_i8x16_bitmask(wasm_i8x16_narrow_i16x8(low, high));
    return static_cast<unsigned>(__builtin_ctz(above | 0x10000U)) - 1U;
#else
    unsigned s = start_[8] <= static_cast<int>(slot) ? 8U : 0U;
    s += start_[s + 4] <= static_cast<int>(slot) ? 4U : 0U;
    s += start_[s + 2] <= static_cast<int>(slot) ? 2U : 0U;
    s += start_[s + 1] <= static_cast<int>(slot) ? 1U : 0U;
    return s;
#endif
  }

  /// Updates the model by `symbol`. Each unit of `kHaste` doubles the speed of learning.
  template <int kHaste = 0>
  void Update(unsigned symbol) {
    const int age = start_[kAge];
    const auto rate = static_cast<std::int16_t>(detail::kRates.rates[age] - kHaste);
    start_[kAge] = static_cast<std::int16_t>(std::min(age + 1, int{detail::Rates::kOldest}));
    for (unsigned i = 0; i < kNibbles; i += 8) {
      Vector target;
      Vector start;
      std::memcpy(&target, &detail::kTargets.starts[symbol][i], sizeof target);
      std::memcpy(&start, &start_[i], sizeof start);
      start += (target - start) >> rate;
      std::memcpy(&start_[i], &start, sizeof start);
    }
  }

  /// Copies the distribution of `other` if this model has not been updated yet.
  void InheritOnce(const NibbleModel& other) {
    if (start_[kAge] == 0) std::copy_n(other.start_.begin(), kNibbles, start_.begin());
  }

  class ZeroRun;

  /// Returns the mean of four distributions. It is computed as the mean of two means, and each mean
  /// is rounded down. The starts of all four distributions are strictly increasing, so the starts
  /// of their mean are, too.
  static NibbleModel Blend(const BlendedModels& models) {
    NibbleModel blend{Unset()};
    for (unsigned i = 0; i < kNibbles; i += 8) {
      const auto load = [&](unsigned k) {
        Vector v;
        std::memcpy(&v, &models[k]->start_[i], sizeof v);
        return v;
      };
      const Vector start = MeanOf(MeanOf(load(0), load(1)), MeanOf(load(2), load(3)));
      std::memcpy(&blend.start_[i], &start, sizeof start);
    }
    blend.start_[kNibbles] = static_cast<std::int16_t>(kProbabilityOne - 65536);
    return blend;
  }
  /// Returns Blend(models).IntervalOf(symbol).
  static Interval BlendedInterval(const BlendedModels& models, unsigned symbol) {
    const auto mean = [&](unsigned at) {
      const auto start = [&](unsigned k) {
        return static_cast<std::uint16_t>(models[k]->start_[at]);
      };
      return static_cast<std::uint32_t>(((start(0) + start(1)) >> 1) +
                                        ((start(2) + start(3)) >> 1)) >>
             1;
    };
    const std::uint32_t start = mean(symbol);
    return {static_cast<std::uint16_t>(start),
            static_cast<std::uint16_t>(mean(symbol + 1) - start)};
  }

 private:
  struct Unset {};
  explicit NibbleModel(Unset) {}
  using Vector = std::int16_t __attribute__((vector_size(16)));
  static Vector MeanOf(Vector a, Vector b) { return (a & b) + ((a ^ b) >> 1); }
  static constexpr unsigned kAge = kNibbles + 1;
  static constexpr std::uint32_t kFloor = 8;
  static std::array<std::uint16_t, kNibbles> UniformCounts() {
    std::array<std::uint16_t, kNibbles> counts;
    counts.fill(1);
    return counts;
  }

  // [0] to [15] are the starts of the symbols' intervals. [0] is always 0. [16] is kProbabilityOne
  // (read unsigned). [17] is the number of updates so far, at most Rates::kOldest.
  alignas(64) std::array<std::int16_t, 32> start_{};
};

/// Blends four different models during a run of symbols 0. It works on copies of the models, which
/// stay in registers. Store() must be called at the end, to update the models themselves.
class NibbleModel::ZeroRun {
 public:
  /// Returns true if all models have reached the final learning rate, which ZeroRun requires.
  static bool IsReady(const BlendedModels& models) {
    return std::all_of(models.begin(), models.end(), [](const NibbleModel* model) {
      return model->start_[kAge] == detail::Rates::kOldest;
    });
  }
  explicit ZeroRun(const BlendedModels& models) {
    for (unsigned k = 0; k < models.size(); ++k)
      for (unsigned half = 0; half < 2; ++half)
        std::memcpy(&starts_[k][half], &models[k]->start_[half * kLanes], sizeof(Vector));
  }
  void Store(const BlendedModels& models) const {
    for (unsigned k = 0; k < models.size(); ++k)
      for (unsigned half = 0; half < 2; ++half)
        std::memcpy(&models[k]->start_[half * kLanes], &starts_[k][half], sizeof(Vector));
  }
  /// Returns the blended interval of symbol 0.
  Interval interval() const {
    const auto start = [&](unsigned k) { return static_cast<std::uint32_t>(starts_[k][0][1]); };
    return {0, static_cast<std::uint16_t>(
                   (((start(0) + start(1)) >> 1) + ((start(2) + start(3)) >> 1)) >> 1)};
  }
  /// Updates the copies after a symbol 0, as Update<kBlendedHaste>() does.
  void Update() {
    constexpr auto kRate =
        static_cast<std::int16_t>(detail::kRates.rates[detail::Rates::kOldest] - kBlendedHaste);
    for (unsigned half = 0; half < 2; ++half) {
      Vector target;
      std::memcpy(&target, &detail::kTargets.starts[0][half * kLanes], sizeof target);
      for (auto& start : starts_) start[half] += (target - start[half]) >> kRate;
    }
  }

 private:
  static constexpr unsigned kLanes = 8;
  std::array<std::array<Vector, 2>, std::tuple_size_v<BlendedModels>> starts_;
};

}  // namespace lidar::codec
