// SPDX-License-Identifier: LGPL-2.1-or-later
// Processes eight counters, votes or weights at once, by vector instructions. The results are the
// same on all processors.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "src/codec/mixing/arithmetic.h"

#if defined(__x86_64__)
#include <emmintrin.h>
#elif defined(__aarch64__) && defined(__AARCH64EL__)
#include <arm_neon.h>
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif

namespace lidar::codec::mixing {

constexpr unsigned kLanes = 8;

/// Lanes in plain C++, for any processor. The variants for some processors have the same functions:
/// - Of() packs eight numbers. Load() and Store() copy `kCount` counters from and to memory. The
///   other lanes have votes of 0.
/// - Votes() returns the votes of counters with the given logits. Learnt() returns counters as they
///   are after a bit.
/// - Join() merges two groups of numbers. In each lane, at least one of the two numbers must be 0.
///   Twice() doubles numbers.
/// - Dot() multiplies inputs by weights and returns the sum in parts. Plus() adds two sums in
///   parts. Total() adds up the parts of a sum.
/// - Teach() adds (input step + 2^16) / 2^17, rounded down, to each weight, and clamps it to an
///   int16.
struct PlainLanes {
  using Eight = std::array<std::int16_t, kLanes>;
  using Sum = std::int32_t;
  using Counters = std::array<Counter, kLanes>;

  static Eight Of(const Eight& numbers) { return numbers; }
  template <unsigned kCount>
  static Counters Load(const Counter* const* from) {
    Counters counters;
    counters.fill({0, 0});
    for (unsigned i = 0; i < kCount; ++i) counters[i] = *from[i];
    return counters;
  }
  template <unsigned kCount>
  static void Store(const Counters& counters, Counter* const* to) {
    for (unsigned i = 0; i < kCount; ++i) *to[i] = counters[i];
  }
  static Eight Votes(const Eight& logits, const Counters& counters) {
    Eight votes;
    for (unsigned i = 0; i < kLanes; ++i)
      votes[i] = static_cast<std::int16_t>(counters[i].Vote(logits[i]));
    return votes;
  }
  static Counters Learnt(Counters counters, bool bit) {
    for (Counter& counter : counters) counter.Learn(bit);
    return counters;
  }
  static Eight Join(const Eight& a, const Eight& b) {
    Eight joined;
    for (unsigned i = 0; i < kLanes; ++i) joined[i] = static_cast<std::int16_t>(a[i] | b[i]);
    return joined;
  }
  static Eight Twice(const Eight& a) {
    Eight doubled;
    for (unsigned i = 0; i < kLanes; ++i) doubled[i] = static_cast<std::int16_t>(2 * a[i]);
    return doubled;
  }
  static Sum Dot(const Eight& inputs, const std::int16_t* weights) {
    Sum sum = 0;
    for (unsigned i = 0; i < kLanes; ++i) sum += inputs[i] * weights[i];
    return sum;
  }
  static Sum Plus(Sum a, Sum b) { return a + b; }
  static std::int32_t Total(Sum sum) { return sum; }
  static void Teach(const Eight& inputs, std::int32_t step, std::int16_t* weights) {
    for (unsigned i = 0; i < kLanes; ++i) {
      const std::int32_t moved = weights[i] + ((inputs[i] * step + (1 << 16)) >> 17);
      weights[i] = static_cast<std::int16_t>(std::clamp(moved, -32'768, 32'767));
    }
  }
};

#if defined(__x86_64__)
/// Lanes for x86-64. Every x86-64 processor has SSE2.
struct Sse2Lanes {
  using Eight = __m128i;
  using Sum = __m128i;
  struct Counters {
    Eight rates, chances;
  };

  [[gnu::always_inline]] static Eight Of(const std::array<std::int16_t, kLanes>& n) {
    return _mm_setr_epi16(n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7]);
  }
  template <unsigned kCount>
  [[gnu::always_inline]] static Counters Load(const Counter* const* from) {
    const __m128i zero = _mm_setzero_si128();
    // `low` has four rates, then four chances.
    const __m128i low = _mm_unpacklo_epi32(Pair<kCount, 0>(from), Pair<kCount, 2>(from));
    if constexpr (kCount <= 4)
      return {_mm_unpacklo_epi64(low, zero), _mm_unpackhi_epi64(low, zero)};
    const __m128i high = _mm_unpacklo_epi32(Pair<kCount, 4>(from), Pair<kCount, 6>(from));
    return {_mm_unpacklo_epi64(low, high), _mm_unpackhi_epi64(low, high)};
  }
  template <unsigned kCount>
  [[gnu::always_inline]] static void Store(const Counters& counters, Counter* const* to) {
    StoreFour<kCount>(_mm_unpacklo_epi16(counters.rates, counters.chances), to);
    if constexpr (kCount > 4)
      StoreFour<kCount - 4>(_mm_unpackhi_epi16(counters.rates, counters.chances), to + 4);
  }
  [[gnu::always_inline]] static Eight Votes(Eight logits, const Counters& counters) {
    const Eight doubt = _mm_add_epi16(counters.rates, _mm_srli_epi16(counters.rates, 1));
    const Eight sure = _mm_srli_epi16(_mm_xor_si128(doubt, _mm_set1_epi16(-1)), 1);
    return _mm_mulhi_epi16(_mm_add_epi16(logits, logits), sure);
  }
  [[gnu::always_inline]] static Counters Learnt(const Counters& counters, bool bit) {
    const Eight mirror = _mm_set1_epi16(bit ? -1 : 0);
    const Eight miss = _mm_xor_si128(counters.chances, mirror);
    const Eight left = _mm_sub_epi16(miss, _mm_mulhi_epu16(miss, counters.rates));
    const Eight rates = counters.rates;
    const Eight square = _mm_mulhi_epu16(rates, rates);
    const Eight less = _mm_mulhi_epu16(rates, _mm_sub_epi16(rates, _mm_srli_epi16(square, 1)));
    return {_mm_sub_epi16(rates, less), _mm_xor_si128(left, mirror)};
  }
  [[gnu::always_inline]] static Eight Join(Eight a, Eight b) { return _mm_or_si128(a, b); }
  [[gnu::always_inline]] static Eight Twice(Eight a) { return _mm_add_epi16(a, a); }
  [[gnu::always_inline]] static Sum Dot(Eight inputs, const std::int16_t* weights) {
    return _mm_madd_epi16(inputs, _mm_load_si128(reinterpret_cast<const __m128i*>(weights)));
  }
  [[gnu::always_inline]] static Sum Plus(Sum a, Sum b) { return _mm_add_epi32(a, b); }
  [[gnu::always_inline]] static std::int32_t Total(Sum sum) {
    sum = _mm_add_epi32(sum, _mm_shuffle_epi32(sum, 0x4E));
    return _mm_cvtsi128_si32(_mm_add_epi32(sum, _mm_shuffle_epi32(sum, 0xB1)));
  }
  [[gnu::always_inline]] static void Teach(Eight inputs, std::int32_t step, std::int16_t* weights) {
    auto* at = reinterpret_cast<__m128i*>(weights);
    const Eight product = _mm_mulhi_epi16(inputs, _mm_set1_epi16(static_cast<std::int16_t>(step)));
    const Eight moves = _mm_srai_epi16(_mm_add_epi16(product, _mm_set1_epi16(1)), 1);
    _mm_store_si128(at, _mm_adds_epi16(_mm_load_si128(at), moves));
  }

 private:
  [[gnu::always_inline]] static __m128i LoadOne(const Counter* from) {
    std::int32_t word;
    std::memcpy(&word, from, sizeof word);
    return _mm_cvtsi32_si128(word);
  }
  /// Returns the rates of two counters, then their chances.
  template <unsigned kCount, unsigned kFirst>
  [[gnu::always_inline]] static __m128i Pair(const Counter* const* from) {
    __m128i first = _mm_setzero_si128();
    __m128i second = _mm_setzero_si128();
    if constexpr (kFirst < kCount) first = LoadOne(from[kFirst]);
    if constexpr (kFirst + 1 < kCount) second = LoadOne(from[kFirst + 1]);
    return _mm_unpacklo_epi16(first, second);
  }
  [[gnu::always_inline]] static void StoreOne(__m128i words, Counter* to) {
    const std::int32_t word = _mm_cvtsi128_si32(words);
    std::memcpy(static_cast<void*>(to), &word, sizeof word);
  }
  template <unsigned kCount>
  [[gnu::always_inline]] static void StoreFour(__m128i words, Counter* const* to) {
    StoreOne(words, to[0]);
    if constexpr (kCount > 1) StoreOne(_mm_shuffle_epi32(words, 1), to[1]);
    if constexpr (kCount > 2) StoreOne(_mm_shuffle_epi32(words, 2), to[2]);
    if constexpr (kCount > 3) StoreOne(_mm_shuffle_epi32(words, 3), to[3]);
  }
};
using FastLanes = Sse2Lanes;
#elif defined(__aarch64__) && defined(__AARCH64EL__)
struct NeonLanes {
  using Eight = int16x8_t;
  using Sum = int32x4_t;
  struct Counters {
    uint16x8_t rates, chances;
  };

  [[gnu::always_inline]] static Eight Of(const std::array<std::int16_t, kLanes>& n) {
    return Eight{n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7]};
  }
  template <unsigned kCount>
  [[gnu::always_inline]] static Counters Load(const Counter* const* from) {
    const uint16x8_t low = LoadFour<kCount>(from);
    uint16x8_t high = vdupq_n_u16(0);
    if constexpr (kCount > 4) high = LoadFour<kCount - 4>(from + 4);
    return {vuzp1q_u16(low, high), vuzp2q_u16(low, high)};
  }
  template <unsigned kCount>
  [[gnu::always_inline]] static void Store(const Counters& counters, Counter* const* to) {
    StoreFour<kCount>(vzip1q_u16(counters.rates, counters.chances), to);
    if constexpr (kCount > 4)
      StoreFour<kCount - 4>(vzip2q_u16(counters.rates, counters.chances), to + 4);
  }
  [[gnu::always_inline]] static Eight Votes(Eight logits, const Counters& counters) {
    const uint16x8_t doubt = vaddq_u16(counters.rates, vshrq_n_u16(counters.rates, 1));
    const uint16x8_t sure = vshrq_n_u16(vmvnq_u16(doubt), 1);
    return vqdmulhq_s16(logits, vreinterpretq_s16_u16(sure));  // upper half of twice the product
  }
  [[gnu::always_inline]] static Counters Learnt(const Counters& counters, bool bit) {
    const uint16x8_t mirror = vdupq_n_u16(bit ? 0xFFFF : 0);
    const uint16x8_t miss = veorq_u16(counters.chances, mirror);
    const uint16x8_t left = vsubq_u16(miss, High(miss, counters.rates));
    const uint16x8_t rates = counters.rates;
    const uint16x8_t square = High(rates, rates);
    const uint16x8_t less = High(rates, vsubq_u16(rates, vshrq_n_u16(square, 1)));
    return {vsubq_u16(rates, less), veorq_u16(left, mirror)};
  }
  [[gnu::always_inline]] static Eight Join(Eight a, Eight b) { return vorrq_s16(a, b); }
  [[gnu::always_inline]] static Eight Twice(Eight a) { return vaddq_s16(a, a); }
  [[gnu::always_inline]] static Sum Dot(Eight inputs, const std::int16_t* weights) {
    const int16x8_t w = vld1q_s16(weights);
    return vmlal_high_s16(vmull_s16(vget_low_s16(inputs), vget_low_s16(w)), inputs, w);
  }
  [[gnu::always_inline]] static Sum Plus(Sum a, Sum b) { return vaddq_s32(a, b); }
  [[gnu::always_inline]] static std::int32_t Total(Sum sum) { return vaddvq_s32(sum); }
  [[gnu::always_inline]] static void Teach(Eight inputs, std::int32_t step, std::int16_t* weights) {
    const auto factor = static_cast<std::int16_t>(step);
    const int16x4_t low = vshrn_n_s32(vmull_n_s16(vget_low_s16(inputs), factor), 16);
    const int16x8_t product = vshrn_high_n_s32(low, vmull_high_n_s16(inputs, factor), 16);
    vst1q_s16(weights, vqaddq_s16(vld1q_s16(weights), vrshrq_n_s16(product, 1)));
  }

 private:
  [[gnu::always_inline]] static uint16x8_t High(uint16x8_t a, uint16x8_t b) {
    const uint16x4_t low = vshrn_n_u32(vmull_u16(vget_low_u16(a), vget_low_u16(b)), 16);
    return vshrn_high_n_u32(low, vmull_high_u16(a, b), 16);
  }
  [[gnu::always_inline]] static std::uint32_t WordOf(const Counter* from) {
    std::uint32_t word;
    std::memcpy(&word, from, sizeof word);
    return word;
  }
  template <unsigned kCount>
  [[gnu::always_inline]] static uint16x8_t LoadFour(const Counter* const* from) {
    uint32x4_t words = vsetq_lane_u32(WordOf(from[0]), vdupq_n_u32(0), 0);
    if constexpr (kCount > 1) words = vsetq_lane_u32(WordOf(from[1]), words, 1);
    if constexpr (kCount > 2) words = vsetq_lane_u32(WordOf(from[2]), words, 2);
    if constexpr (kCount > 3) words = vsetq_lane_u32(WordOf(from[3]), words, 3);
    return vreinterpretq_u16_u32(words);
  }
  [[gnu::always_inline]] static void StoreOne(std::uint32_t word, Counter* to) {
    std::memcpy(static_cast<void*>(to), &word, sizeof word);
  }
  template <unsigned kCount>
  [[gnu::always_inline]] static void StoreFour(uint16x8_t pairs, Counter* const* to) {
    const uint32x4_t words = vreinterpretq_u32_u16(pairs);
    StoreOne(vgetq_lane_u32(words, 0), to[0]);
    if constexpr (kCount > 1) StoreOne(vgetq_lane_u32(words, 1), to[1]);
    if constexpr (kCount > 2) StoreOne(vgetq_lane_u32(words, 2), to[2]);
    if constexpr (kCount > 3) StoreOne(vgetq_lane_u32(words, 3), to[3]);
  }
};
using FastLanes = NeonLanes;
#elif defined(__wasm_simd128__)
struct WasmLanes {
  using Eight = v128_t;
  using Sum = v128_t;
  struct Counters {
    Eight rates, chances;
  };

  [[gnu::always_inline]] static Eight Of(const std::array<std::int16_t, kLanes>& n) {
    return wasm_i16x8_make(n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7]);
  }
  template <unsigned kCount>
  [[gnu::always_inline]] static Counters Load(const Counter* const* from) {
    const v128_t low = LoadFour<kCount>(from);
    v128_t high = wasm_i16x8_const_splat(0);
    if constexpr (kCount > 4) high = LoadFour<kCount - 4>(from + 4);
    return {wasm_i16x8_shuffle(low, high, 0, 2, 4, 6, 8, 10, 12, 14),
            wasm_i16x8_shuffle(low, high, 1, 3, 5, 7, 9, 11, 13, 15)};
  }
  template <unsigned kCount>
  [[gnu::always_inline]] static void Store(const Counters& counters, Counter* const* to) {
    const v128_t &rates = counters.rates, &chances = counters.chances;
    StoreFour<kCount>(wasm_i16x8_shuffle(rates, chances, 0, 8, 1, 9, 2, 10, 3, 11), to);
    if constexpr (kCount > 4)
      StoreFour<kCount - 4>(wasm_i16x8_shuffle(rates, chances, 4, 12, 5, 13, 6, 14, 7, 15), to + 4);
  }
  [[gnu::always_inline]] static Eight Votes(Eight logits, const Counters& counters) {
    const Eight doubt = wasm_i16x8_add(counters.rates, wasm_u16x8_shr(counters.rates, 1));
    const Eight sure = wasm_u16x8_shr(wasm_v128_not(doubt), 1);
    return SignedHigh(wasm_i16x8_add(logits, logits), sure);
  }
  [[gnu::always_inline]] static Counters Learnt(const Counters& counters, bool bit) {
    const Eight mirror = wasm_i16x8_splat(bit ? -1 : 0);
    const Eight miss = wasm_v128_xor(counters.chances, mirror);
    const Eight left = wasm_i16x8_sub(miss, High(miss, counters.rates));
    const Eight rates = counters.rates;
    const Eight square = High(rates, rates);
    const Eight less = High(rates, wasm_i16x8_sub(rates, wasm_u16x8_shr(square, 1)));
    return {wasm_i16x8_sub(rates, less), wasm_v128_xor(left, mirror)};
  }
  [[gnu::always_inline]] static Eight Join(Eight a, Eight b) { return wasm_v128_or(a, b); }
  [[gnu::always_inline]] static Eight Twice(Eight a) { return wasm_i16x8_add(a, a); }
  [[gnu::always_inline]] static Sum Dot(Eight inputs, const std::int16_t* weights) {
    return wasm_i32x4_dot_i16x8(inputs, wasm_v128_load(weights));
  }
  [[gnu::always_inline]] static Sum Plus(Sum a, Sum b) { return wasm_i32x4_add(a, b); }
  [[gnu::always_inline]] static std::int32_t Total(Sum sum) {
    sum = wasm_i32x4_add(sum, wasm_i32x4_shuffle(sum, sum, 2, 3, 0, 1));
    return wasm_i32x4_extract_lane(sum, 0) + wasm_i32x4_extract_lane(sum, 1);
  }
  [[gnu::always_inline]] static void Teach(Eight inputs, std::int32_t step, std::int16_t* weights) {
    const Eight product = SignedHigh(inputs, wasm_i16x8_splat(static_cast<std::int16_t>(step)));
    const Eight moves = wasm_i16x8_shr(wasm_i16x8_add(product, wasm_i16x8_const_splat(1)), 1);
    wasm_v128_store(weights, wasm_i16x8_add_sat(wasm_v128_load(weights), moves));
  }

 private:
  /// Returns the upper halves of 32-bit products.
  [[gnu::always_inline]] static v128_t Upper(v128_t low, v128_t high) {
    return wasm_i16x8_shuffle(low, high, 1, 3, 5, 7, 9, 11, 13, 15);
  }
  [[gnu::always_inline]] static v128_t High(v128_t a, v128_t b) {
    return Upper(wasm_u32x4_extmul_low_u16x8(a, b), wasm_u32x4_extmul_high_u16x8(a, b));
  }
  [[gnu::always_inline]] static v128_t SignedHigh(v128_t a, v128_t b) {
    return Upper(wasm_i32x4_extmul_low_i16x8(a, b), wasm_i32x4_extmul_high_i16x8(a, b));
  }
  template <unsigned kCount>
  [[gnu::always_inline]] static v128_t LoadFour(const Counter* const* from) {
    v128_t words = wasm_v128_load32_zero(from[0]);
    if constexpr (kCount > 1) words = wasm_v128_load32_lane(from[1], words, 1);
    if constexpr (kCount > 2) words = wasm_v128_load32_lane(from[2], words, 2);
    if constexpr (kCount > 3) words = wasm_v128_load32_lane(from[3], words, 3);
    return words;
  }
  template <unsigned kCount>
  [[gnu::always_inline]] static void StoreFour(v128_t pairs, Counter* const* to) {
    wasm_v128_store32_lane(to[0], pairs, 0);
    if constexpr (kCount > 1) wasm_v128_store32_lane(to[1], pairs, 1);
    if constexpr (kCount > 2) wasm_v128_store32_lane(to[2], pairs, 2);
    if constexpr (kCount > 3) wasm_v128_store32_lane(to[3], pairs, 3);
  }
};
using FastLanes = WasmLanes;
#else
using FastLanes = PlainLanes;
#endif

}  // namespace lidar::codec::mixing
