// SPDX-License-Identifier: LGPL-2.1-or-later
// An adaptive probability distribution over 16 symbols, updated with vector instructions.
#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace lidar::codec {

constexpr unsigned kNibbles = 16;
constexpr unsigned kProbabilityBits = 15;
constexpr std::uint32_t kProbabilityOne = 1U << kProbabilityBits;

/// What an entropy coder needs to know about a symbol: its interval in 0 .. kProbabilityOne.
struct Interval {
  std::uint16_t start;
  std::uint16_t size;
};

namespace detail {

/// Zeros, then the largest start that leaves room for all symbols behind it.
struct Steps {
  constexpr Steps() {
    for (unsigned i = kNibbles; i < 2 * kNibbles; ++i)
      values[i] = static_cast<std::int16_t>(kProbabilityOne - kNibbles);
  }
  std::int16_t values[2 * kNibbles] = {};
};
struct Slope {
  constexpr Slope() {
    for (unsigned i = 0; i < kNibbles; ++i) values[i] = static_cast<std::int16_t>(i);
  }
  std::int16_t values[kNibbles] = {};
};
inline constexpr Steps kSteps;
inline constexpr Slope kSlope;

}  // namespace detail

/// After F. Giesen, "Mixing discrete probability distributions" (2015): the cumulative
/// distribution moves towards one that has nearly all of its mass on the symbol seen. Every symbol
/// keeps a probability above zero, because both ends of each step are strictly increasing.
class NibbleModel {
 public:
  /// Uniform.
  NibbleModel() : NibbleModel(UniformCounts()) {}
  /// Proportional to `counts`, of which zeros count as a little.
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

  /// The symbol whose interval holds `slot` < kProbabilityOne.
  unsigned Find(std::uint32_t slot) const {
#ifdef __SSE2__
    const __m128i v = _mm_set1_epi16(static_cast<std::int16_t>(slot));
    const __m128i low = _mm_load_si128(reinterpret_cast<const __m128i*>(start_.data()));
    const __m128i high = _mm_load_si128(reinterpret_cast<const __m128i*>(start_.data() + 8));
    const int above =
        _mm_movemask_epi8(_mm_packs_epi16(_mm_cmpgt_epi16(low, v), _mm_cmpgt_epi16(high, v)));
    return static_cast<unsigned>(__builtin_ctz(static_cast<unsigned>(above) | 0x10000U)) - 1;
#else
    unsigned s = start_[8] <= static_cast<int>(slot) ? 8 : 0;
    s += start_[s + 4] <= static_cast<int>(slot) ? 4 : 0;
    s += start_[s + 2] <= static_cast<int>(slot) ? 2 : 0;
    s += start_[s + 1] <= static_cast<int>(slot) ? 1 : 0;
    return s;
#endif
  }

  void Update(unsigned symbol) {
    const int age = start_[kAge];
    const int rate = kFast + (age >= kMiddleAge ? 1 : 0) + (age >= kOldest ? 1 : 0);
    start_[kAge] = static_cast<std::int16_t>(age + (age < kOldest ? 1 : 0));
    // The table is a step at `symbol`; the slope keeps intervals from vanishing.
    const std::int16_t* step = &detail::kSteps.values[kNibbles - 1 - symbol];
    for (unsigned i = 0; i < kNibbles; i += 8) {
      Vector target;
      Vector slope;
      Vector start;
      std::memcpy(&target, step + i, sizeof target);
      std::memcpy(&slope, &detail::kSlope.values[i], sizeof slope);
      std::memcpy(&start, &start_[i], sizeof start);
      start += (target + slope - start) >> static_cast<std::int16_t>(rate);
      std::memcpy(&start_[i], &start, sizeof start);
    }
  }

 private:
  using Vector = std::int16_t __attribute__((vector_size(16)));
  static constexpr unsigned kAge = kNibbles + 1;
  static constexpr std::int16_t kOldest = 400;
  static constexpr std::uint32_t kFloor = 8;
  // Fast at first, then slower: few samples teach a context most of what there is to know.
  static constexpr int kFast = 5;
  static constexpr int kMiddleAge = 24;
  static std::array<std::uint16_t, kNibbles> UniformCounts() {
    std::array<std::uint16_t, kNibbles> counts;
    counts.fill(1);
    return counts;
  }

  // [0] is 0 for ever, [16] is kProbabilityOne (read unsigned), [17] the number of updates so far.
  alignas(16) std::array<std::int16_t, 24> start_{};
};

}  // namespace lidar::codec
