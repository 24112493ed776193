// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/mixing/mixer.h"

#include <algorithm>

#if defined(__x86_64__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

namespace lidar::codec::mixing {
namespace {

constexpr unsigned kWeightShift = 4;
constexpr unsigned kStepShift = 14;
constexpr std::int32_t kHalfStep = 1 << (kStepShift - 1);

using Four = Kernel::Four;

std::int32_t ScalarDot(Four a, Four b, Four c, Four d, const Weights* weights) {
  const Inputs inputs{{a, b, c, d}};
  std::int32_t sum = 0;
  for (unsigned i = 0; i < kInputs; ++i) sum += inputs.At(i) * (weights->values[i] >> kWeightShift);
  return sum;
}

Sums ScalarDots(Four a, Four b, Four c, Four d, const Weights* first, const Weights* second) {
  return {ScalarDot(a, b, c, d, first), ScalarDot(a, b, c, d, second)};
}

void ScalarLearn(Four a, Four b, Four c, Four d, std::int32_t step, Weights* weights) {
  const Inputs inputs{{a, b, c, d}};
  for (unsigned i = 0; i < kInputs; ++i) {
    const std::int32_t moved =
        weights->values[i] + ((inputs.At(i) * step + kHalfStep) >> kStepShift);
    weights->values[i] = std::clamp(moved, -kMostWeight, kMostWeight);
  }
}

#if defined(__x86_64__)
// SSE2 belongs to every x86-64.
__m128i Load(const std::int32_t* at) {
  return _mm_load_si128(reinterpret_cast<const __m128i*>(at));
}
__m128i Join(Four low, Four high) {
  return _mm_set_epi64x(static_cast<long long>(high), static_cast<long long>(low));
}

__m128i DotEight(__m128i logits, const std::int32_t* weights) {
  const __m128i low = _mm_srai_epi32(Load(weights), kWeightShift);
  const __m128i high = _mm_srai_epi32(Load(weights + 4), kWeightShift);
  return _mm_madd_epi16(logits, _mm_packs_epi32(low, high));
}
__m128i DotPairs(__m128i low, __m128i high, const Weights* weights) {
  return _mm_add_epi32(DotEight(low, weights->values.data()),
                       DotEight(high, weights->values.data() + 8));
}

std::int32_t Sse2Dot(Four a, Four b, Four c, Four d, const Weights* weights) {
  __m128i sum = DotPairs(Join(a, b), Join(c, d), weights);
  sum = _mm_add_epi32(sum, _mm_shuffle_epi32(sum, 0x4E));
  sum = _mm_add_epi32(sum, _mm_shuffle_epi32(sum, 0xB1));
  return _mm_cvtsi128_si32(sum);
}

/// The sums of four numbers each.
Sums AddUp(__m128i first, __m128i second) {
  __m128i sum = _mm_add_epi32(_mm_unpacklo_epi32(first, second), _mm_unpackhi_epi32(first, second));
  sum = _mm_add_epi32(sum, _mm_shuffle_epi32(sum, 0x4E));
  return {_mm_cvtsi128_si32(sum), _mm_cvtsi128_si32(_mm_shuffle_epi32(sum, 1))};
}

Sums Sse2Dots(Four a, Four b, Four c, Four d, const Weights* first, const Weights* second) {
  const __m128i low = Join(a, b);
  const __m128i high = Join(c, d);
  return AddUp(DotPairs(low, high, first), DotPairs(low, high, second));
}

/// The bits of `a` where `mask` is set, else those of `b`.
__m128i Choose(__m128i mask, __m128i a, __m128i b) {
  return _mm_or_si128(_mm_and_si128(mask, a), _mm_andnot_si128(mask, b));
}

void MoveFour(__m128i product, std::int32_t* weights) {
  const __m128i most = _mm_set1_epi32(kMostWeight);
  const __m128i least = _mm_set1_epi32(-kMostWeight);
  __m128i w = _mm_add_epi32(Load(weights), _mm_srai_epi32(product, kStepShift));
  w = Choose(_mm_cmpgt_epi32(w, most), most, w);
  w = Choose(_mm_cmplt_epi32(w, least), least, w);
  _mm_store_si128(reinterpret_cast<__m128i*>(weights), w);
}

void Sse2Learn(Four a, Four b, Four c, Four d, std::int32_t step, Weights* weights) {
  // Pairs (logit, 1) times pairs (step, half): the rounding comes with the product.
  const __m128i factor = _mm_set1_epi32((step & 0xFFFF) | kHalfStep << 16);
  const __m128i one = _mm_set1_epi16(1);
  std::int32_t* at = weights->values.data();
  for (const __m128i x : {Join(a, b), Join(c, d)}) {
    MoveFour(_mm_madd_epi16(_mm_unpacklo_epi16(x, one), factor), at);
    MoveFour(_mm_madd_epi16(_mm_unpackhi_epi16(x, one), factor), at + 4);
    at += 8;
  }
}
constexpr Kernel kSse2Kernel = {"sse2", Sse2Dot, Sse2Dots, Sse2Learn};

[[gnu::target("avx2")]] __m128i Avx2Pairs(__m256i x, const Weights* weights) {
  const auto* w = reinterpret_cast<const __m256i*>(weights->values.data());
  const __m256i low = _mm256_srai_epi32(_mm256_load_si256(w), kWeightShift);
  const __m256i high = _mm256_srai_epi32(_mm256_load_si256(w + 1), kWeightShift);
  // The pack works in halves: 0-3 and 8-11, then 4-7 and 12-15.
  const __m256i packed = _mm256_permute4x64_epi64(_mm256_packs_epi32(low, high), 0xD8);
  const __m256i pairs = _mm256_madd_epi16(x, packed);
  return _mm_add_epi32(_mm256_castsi256_si128(pairs), _mm256_extracti128_si256(pairs, 1));
}

[[gnu::target("avx2")]] std::int32_t Avx2Dot(Four a, Four b, Four c, Four d,
                                             const Weights* weights) {
  __m128i sum = Avx2Pairs(_mm256_set_m128i(Join(c, d), Join(a, b)), weights);
  sum = _mm_add_epi32(sum, _mm_shuffle_epi32(sum, 0x4E));
  sum = _mm_add_epi32(sum, _mm_shuffle_epi32(sum, 0xB1));
  return _mm_cvtsi128_si32(sum);
}

[[gnu::target("avx2")]] Sums Avx2Dots(Four a, Four b, Four c, Four d, const Weights* first,
                                      const Weights* second) {
  const __m256i x = _mm256_set_m128i(Join(c, d), Join(a, b));
  return AddUp(Avx2Pairs(x, first), Avx2Pairs(x, second));
}

[[gnu::target("avx2")]] void Avx2Learn(Four a, Four b, Four c, Four d, std::int32_t step,
                                       Weights* weights) {
  const __m256i factor = _mm256_set1_epi32(step);
  const __m256i half = _mm256_set1_epi32(kHalfStep);
  const __m256i most = _mm256_set1_epi32(kMostWeight);
  const __m256i least = _mm256_set1_epi32(-kMostWeight);
  auto* at = reinterpret_cast<__m256i*>(weights->values.data());
  for (const __m128i eight : {Join(a, b), Join(c, d)}) {
    const __m256i x = _mm256_cvtepi16_epi32(eight);
    const __m256i product = _mm256_add_epi32(_mm256_mullo_epi32(x, factor), half);
    const __m256i w =
        _mm256_add_epi32(_mm256_load_si256(at), _mm256_srai_epi32(product, kStepShift));
    _mm256_store_si256(at, _mm256_max_epi32(_mm256_min_epi32(w, most), least));
    ++at;
  }
}
constexpr Kernel kAvx2Kernel = {"avx2", Avx2Dot, Avx2Dots, Avx2Learn};
#elif defined(__aarch64__)
std::int32_t NeonDot(Four a, Four b, Four c, Four d, const Weights* weights) {
  int32x4_t sum = vdupq_n_s32(0);
  const std::int32_t* at = weights->values.data();
  for (const Four four : {a, b, c, d}) {
    sum = vmlal_s16(sum, vcreate_s16(four), vshrn_n_s32(vld1q_s32(at), kWeightShift));
    at += 4;
  }
  return vaddvq_s32(sum);
}

Sums NeonDots(Four a, Four b, Four c, Four d, const Weights* first, const Weights* second) {
  return {NeonDot(a, b, c, d, first), NeonDot(a, b, c, d, second)};
}

void NeonLearn(Four a, Four b, Four c, Four d, std::int32_t step, Weights* weights) {
  const int32x4_t most = vdupq_n_s32(kMostWeight);
  const int32x4_t least = vdupq_n_s32(-kMostWeight);
  std::int32_t* at = weights->values.data();
  for (const Four four : {a, b, c, d}) {
    const int32x4_t product =
        vmlal_n_s16(vdupq_n_s32(kHalfStep), vcreate_s16(four), static_cast<std::int16_t>(step));
    const int32x4_t w = vaddq_s32(vld1q_s32(at), vshrq_n_s32(product, kStepShift));
    vst1q_s32(at, vmaxq_s32(vminq_s32(w, most), least));
    at += 4;
  }
}
constexpr Kernel kNeonKernel = {"neon", NeonDot, NeonDots, NeonLearn};
#endif

}  // namespace

const Kernel kScalarKernel = {"scalar", ScalarDot, ScalarDots, ScalarLearn};

std::array<const Kernel*, 4> AllKernels() {
  std::array<const Kernel*, 4> all{&kScalarKernel};
#if defined(__x86_64__)
  all[1] = &kSse2Kernel;
  if (__builtin_cpu_supports("avx2")) all[2] = &kAvx2Kernel;
#elif defined(__aarch64__)
  all[1] = &kNeonKernel;
#endif
  return all;
}

const Kernel& BestKernel() {
  static const Kernel* const best = [] {
    const Kernel* last = nullptr;
    for (const Kernel* kernel : AllKernels()) last = kernel != nullptr ? kernel : last;
    return last;
  }();
  return *best;
}

}  // namespace lidar::codec::mixing
