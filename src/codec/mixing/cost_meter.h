// SPDX-License-Identifier: LGPL-2.1-or-later
// A coder that writes nothing, but adds up what it would cost to code the bits.
#pragma once
#include <cstdint>

#include "src/codec/mixing/arithmetic.h"

namespace lidar::codec::mixing {

/// Costs are integers, in 1/256 nat, so that they are the same on every machine.
class CostMeter {
 public:
  bool Code(bool bit, std::int32_t chance) {
    static constexpr std::int32_t kLogOne = 2'839;  // 256 ln(65536)
    cost_ += kLogOne - Log(static_cast<std::uint32_t>(bit ? chance : kOne - chance));
    return bit;
  }
  /// Returns the cost since the last Take().
  std::int32_t cost() const { return cost_; }
  std::int32_t Take() {
    const std::int32_t cost = cost_;
    cost_ = 0;
    return cost;
  }

 private:
  std::int32_t cost_ = 0;
};

/// True if models learn from the bits that a Coder codes. While costs are measured, the models must
/// stay unchanged.
template <class Coder>
constexpr bool kTeaches = true;
template <>
inline constexpr bool kTeaches<CostMeter> = false;

}  // namespace lidar::codec::mixing
