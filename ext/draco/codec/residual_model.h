// SPDX-License-Identifier: LGPL-2.1-or-later
// Signed integers as symbols of 16 classes and raw bits, adaptively for each context.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>

#include "draco/codec/initial_models.h"
#include "draco/codec/rans.h"

namespace lidar::codec {

/// What a symbol stands for: a sign, and magnitudes from `base` on, one of 2^bits.
struct ResidualClass {
  std::uint32_t base;
  std::uint8_t bits;
  bool negative;
};

/// 0; then for each magnitude 1, 2, 3-4, 5-8, 9-16, 17-32, and from 33 on, one a sign. From 33 on,
/// the length of the rest is a symbol of its own.
constexpr unsigned kLongClass = 6;
constexpr std::array<ResidualClass, kNibbles> kResidualClasses = {{{0, 0, false},
                                                                   {1, 0, false},
                                                                   {1, 0, true},
                                                                   {2, 0, false},
                                                                   {2, 0, true},
                                                                   {3, 1, false},
                                                                   {3, 1, true},
                                                                   {5, 2, false},
                                                                   {5, 2, true},
                                                                   {9, 3, false},
                                                                   {9, 3, true},
                                                                   {17, 4, false},
                                                                   {17, 4, true},
                                                                   {33, 0, false},
                                                                   {33, 0, true},
                                                                   {0, 0, false}}};

/// Encoder and decoder do the same with every residual: one symbol, and bits, if only none; nothing
/// to be mispredicted but the rare long ones.
class ResidualModel {
 public:
  void Reset(const InitialModels& start) {
    models_ = start.residuals;
    long_model_ = start.longs;
  }

  void Encode(std::int32_t residual, unsigned context, RansEncoder* encoder) {
    const unsigned sign = residual < 0 ? 1U : 0U;
    const auto magnitude = static_cast<std::uint32_t>(std::abs(residual));
    // Bit length of magnitude - 1; for 0 any, as it is multiplied away.
    const unsigned length = std::min(BitLength(magnitude - 1), kLongClass);
    const unsigned symbol = (1 + 2 * length + sign) * (magnitude != 0 ? 1U : 0U);
    const ResidualClass& c = kResidualClasses[symbol];
    encoder->Put(symbol, &models_[context]);
    encoder->PutBits(magnitude - c.base, c.bits);
    if (magnitude > 32) EncodeLong(magnitude - 33, encoder);
  }

  std::int32_t Decode(unsigned context, RansDecoder* decoder) {
    const ResidualClass& c = kResidualClasses[decoder->Get(&models_[context])];
    std::uint32_t magnitude = c.base + decoder->GetBits(c.bits);
    if (c.base == 33) magnitude += DecodeLong(decoder);
    const auto value = static_cast<std::int32_t>(magnitude);
    return c.negative ? -value : value;
  }

 private:
  static constexpr unsigned kLongest = 15;

  static unsigned BitLength(std::uint32_t v) {
    return v == 0 ? 0 : 32 - static_cast<unsigned>(__builtin_clz(v));
  }
  void EncodeLong(std::uint32_t rest, RansEncoder* encoder) {
    const unsigned length = std::min(BitLength(rest), kLongest);
    encoder->Put(length, &long_model_);
    encoder->PutBits(rest, PlainBits(length));
  }
  std::uint32_t DecodeLong(RansDecoder* decoder) {
    const unsigned length = decoder->Get(&long_model_);
    const std::uint32_t low = decoder->GetBits(PlainBits(length));
    return length == 0 || length == kLongest ? low : low | 1U << (length - 1);
  }
  /// Of a rest of that length: all but the highest one, which is known to be 1.
  static unsigned PlainBits(unsigned length) {
    if (length == kLongest) return kMaxPlainBits;
    return length > 0 ? length - 1 : 0;
  }

  std::array<NibbleModel, kContexts> models_;
  NibbleModel long_model_;
};

}  // namespace lidar::codec
