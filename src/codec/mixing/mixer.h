// SPDX-License-Identifier: LGPL-2.1-or-later
// Logistic mixing: many opinions on one bit become one, by weights that learn who is right.
#pragma once
#include <array>
#include <cstdint>

#include "src/codec/mixing/arithmetic.h"

namespace lidar::codec::mixing {

constexpr unsigned kInputs = 16;

/// Logits, four in each number, the first in its lowest bits: so they reach a vector register
/// without a way through memory.
struct Inputs {
  std::array<std::uint64_t, kInputs / 4> packed{};

  /// A logit in its place of a number whose other places are 0.
  static std::uint64_t Packed(unsigned place, std::int32_t logit) {
    return std::uint64_t{static_cast<std::uint16_t>(logit)} << (16 * (place % 4));
  }
  std::int32_t At(unsigned place) const {
    return static_cast<std::int16_t>(packed[place / 4] >> (16 * (place % 4)));
  }
};

/// In 1/65536, within +-kMostWeight.
struct alignas(32) Weights {
  std::array<std::int32_t, kInputs> values{};
};
constexpr std::int32_t kMostWeight = (1 << 19) - 1;

struct Sums {
  std::int32_t first;
  std::int32_t second;
};

/// The operations of a mixer, in the instructions of one kind of processor, on four numbers of
/// Inputs. All kernels give the same results.
struct Kernel {
  using Four = std::uint64_t;
  const char* name;
  /// Sum of logits times weights / 16, in 1/4096; for two sets of weights at once.
  std::int32_t (*dot)(Four a, Four b, Four c, Four d, const Weights* weights);
  Sums (*dots)(Four a, Four b, Four c, Four d, const Weights* first, const Weights* second);
  /// weight += (logit step + 2^13) >> 14; `step` fits an int16.
  void (*learn)(Four a, Four b, Four c, Four d, std::int32_t step, Weights* weights);
};

/// For any processor, in plain C++.
extern const Kernel kScalarKernel;
/// The fastest for this processor.
const Kernel& BestKernel();
/// All that this processor has, the scalar one first; null behind the last.
std::array<const Kernel*, 4> AllKernels();

/// How far weights move for an error `bit - chance`.
inline std::int32_t StepOf(bool bit, std::int32_t chance) {
  constexpr std::int32_t kSpeed = 5;
  return ((bit ? kOne : 0) - chance) * kSpeed >> 4;
}

}  // namespace lidar::codec::mixing
