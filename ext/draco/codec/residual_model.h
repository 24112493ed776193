// SPDX-License-Identifier: LGPL-2.1-or-later
// Signed integers as symbols of 16 classes and raw bits, adaptively for each context.
#pragma once
#include <array>
#include <cstdint>

#include "draco/codec/rans.h"

namespace lidar::codec {

/// Classes: 0; then for each magnitude 1, 2, 3-4, 5-8, 9-16, 17-32 and from 33 on, one a sign. The
/// place inside a class is raw bits; from 33 on, its length is a symbol of its own.
template <unsigned kContextCount>
class ResidualModel {
 public:
  void Reset(const std::array<NibbleModel, kContextCount>& start) {
    models_ = start;
    long_model_ = NibbleModel();
  }

  void Encode(std::int32_t residual, unsigned context, RansEncoder* encoder) {
    NibbleModel* model = &models_[context];
    if (residual == 0) return encoder->Put(0, model);
    const unsigned sign = residual < 0 ? 1U : 0U;
    const std::uint32_t rest = (residual < 0 ? 0U - static_cast<std::uint32_t>(residual)
                                             : static_cast<std::uint32_t>(residual)) -
                               1;
    const unsigned length = BitLength(rest);
    if (length < kLongClass) {
      encoder->Put(1 + 2 * length + sign, model);
      if (length > 1) encoder->PutRaw(rest, length - 1);
      return;
    }
    encoder->Put(1 + 2 * kLongClass + sign, model);
    EncodeLong(rest - kLongStart, encoder);
  }

  std::int32_t Decode(unsigned context, RansDecoder* decoder) {
    const unsigned symbol = decoder->Get(&models_[context]);
    if (symbol == 0) return 0;
    const unsigned length = (symbol - 1) >> 1;
    std::uint32_t rest = length;
    if (length > 1 && length < kLongClass) {
      rest = 1U << (length - 1) | decoder->GetRaw(length - 1);
    } else if (length == kLongClass) {
      rest = kLongStart + DecodeLong(decoder);
    }
    const auto magnitude = static_cast<std::int32_t>(rest + 1);
    return (symbol & 1) != 0 ? magnitude : -magnitude;
  }

 private:
  static constexpr unsigned kLongClass = 6;
  static constexpr std::uint32_t kLongStart = 32;  // of magnitude - 1
  static constexpr unsigned kLongest = 15;
  static constexpr unsigned kAllBits = 28;

  static unsigned BitLength(std::uint32_t v) {
    return v == 0 ? 0 : 32 - static_cast<unsigned>(__builtin_clz(v));
  }
  void EncodeLong(std::uint32_t rest, RansEncoder* encoder) {
    const unsigned length = BitLength(rest);
    if (length < kLongest) {
      encoder->Put(length, &long_model_);
      PutMany(rest, length > 0 ? length - 1 : 0, encoder);
    } else {
      encoder->Put(kLongest, &long_model_);
      PutMany(rest, kAllBits, encoder);
    }
  }
  std::uint32_t DecodeLong(RansDecoder* decoder) {
    const unsigned length = decoder->Get(&long_model_);
    if (length < 2) return length;
    if (length < kLongest) return 1U << (length - 1) | GetMany(length - 1, decoder);
    return GetMany(kAllBits, decoder);
  }
  static void PutMany(std::uint32_t value, unsigned bits, RansEncoder* encoder) {
    while (bits > 0) {
      const unsigned part = bits < kMaxRawBits ? bits : kMaxRawBits;
      bits -= part;
      encoder->PutRaw(value >> bits, part);
    }
  }
  static std::uint32_t GetMany(unsigned bits, RansDecoder* decoder) {
    std::uint32_t value = 0;
    while (bits > 0) {
      const unsigned part = bits < kMaxRawBits ? bits : kMaxRawBits;
      bits -= part;
      value = value << part | decoder->GetRaw(part);
    }
    return value;
  }

  std::array<NibbleModel, kContextCount> models_;
  NibbleModel long_model_;
};

}  // namespace lidar::codec
