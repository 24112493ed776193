// SPDX-License-Identifier: LGPL-2.1-or-later
// Computes logits for decisions about a value near a centre. The distance of the value from the
// centre has a logistic distribution, whose width is learnt.
#pragma once
#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "src/codec/mixing/arithmetic.h"

namespace lidar::codec::mixing {

class Centre {
 public:
  /// Sets the centre. `offset` is the distance from the prediction to the centre, in 1/16 bin.
  /// `*spread` is the mean distance of earlier values from the centre, in 1/4096 bin. Learn()
  /// updates it.
  void Set(std::int32_t offset, std::int32_t* spread) {
    offset_ = std::clamp(offset, -kMostOffset, kMostOffset);
    exact_ = offset;
    spread_ = spread;
    inverse_ = (1 << 22) / *spread;
  }

  /// Returns the logit of decision `node` on the difference from the prediction (see kSmallNodes).
  /// The decisions must be asked for in the order in which they are coded, because a call continues
  /// from the result of the call before it.
  [[gnu::always_inline]] std::int32_t Opinion(unsigned node) {
    if (node == 0) {
      below_ = Below(-8);
      above_ = kOne - Below(8);
      return Ratio(below_ + above_, kOne - below_ - above_);
    }
    if (node == 1) return Ratio(below_, above_);
    const std::int32_t edge = kStepWidth * static_cast<std::int32_t>(node >> 1) + kStepWidth / 2;
    std::int32_t& rest = (node & 1) != 0 ? below_ : above_;
    const std::int32_t beyond = (node & 1) != 0 ? Below(-edge) : kOne - Below(edge);
    const std::int32_t within = rest - beyond;
    rest = beyond;
    return Ratio(beyond, within);
  }

  /// Updates the spread by `value`, the difference from the prediction in 1/16 bin.
  void Learn(std::int32_t value) {
    constexpr std::int32_t kMostDistance = 96;
    const std::int32_t distance = std::min(std::abs(value - exact_), kMostDistance);
    *spread_ = std::max(*spread_ + ((256 * distance - *spread_) >> 6), 128);
  }

 private:
  static constexpr std::int32_t kStepWidth = 16;
  static constexpr std::int32_t kMostOffset = 4'095;
  static constexpr std::int32_t kLeast = 4;

  std::int32_t Below(std::int32_t edge) const { return Chance((edge - offset_) * inverse_ >> 6); }
  static std::int32_t Ratio(std::int32_t a, std::int32_t b) {
    return Log(static_cast<std::uint32_t>(std::clamp(a, kLeast, kOne - 1))) -
           Log(static_cast<std::uint32_t>(std::max(b, kLeast)));
  }

  std::int32_t offset_ = 0;
  std::int32_t exact_ = 0;
  std::int32_t inverse_ = 0;
  /// The chances that the value is beyond the last edge that Opinion() computed, on either side.
  std::int32_t below_ = 0;
  std::int32_t above_ = 0;
  std::int32_t* spread_ = nullptr;
};

}  // namespace lidar::codec::mixing
