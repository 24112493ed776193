// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes signed integers, each as a symbol for one of 16 classes, followed by plain bits. The
// probabilities of symbols adapt in each context.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "src/codec/rans/initial_models.h"
#include "src/codec/rans/rans.h"

namespace lidar::codec {

/// The values of a symbol. They have the sign `sign` (0 or -1) and one of 2^bits magnitudes, of
/// which `base` is the smallest.
struct ResidualClass {
  std::int16_t base;
  std::int8_t bits;
  std::int8_t sign;
  std::uint32_t mask;  // has `bits` ones
};
struct Residual {
  std::int32_t magnitude;
  std::int32_t sign;  // 0 or -1
};

/// The classes are 0 and, once for each sign: 1, 2, 3-4, 5-8, 9-16, 17-32, and 33 or more. In the
/// last class, a second symbol follows: the bit length of the magnitude minus 33.
constexpr std::uint32_t kLongMagnitude = 33;
constexpr unsigned kFirstLongSymbol = 13;
constexpr std::array<ResidualClass, kNibbles> kResidualClasses = {{{0, 0, 0, 0},
                                                                   {1, 0, 0, 0},
                                                                   {1, 0, -1, 0},
                                                                   {2, 0, 0, 0},
                                                                   {2, 0, -1, 0},
                                                                   {3, 1, 0, 1},
                                                                   {3, 1, -1, 1},
                                                                   {5, 2, 0, 3},
                                                                   {5, 2, -1, 3},
                                                                   {9, 3, 0, 7},
                                                                   {9, 3, -1, 7},
                                                                   {17, 4, 0, 15},
                                                                   {17, 4, -1, 15},
                                                                   {33, 0, 0, 0},
                                                                   {33, 0, -1, 0},
                                                                   {0, 0, 0, 0}}};

/// The symbol of each magnitude up to kLongMagnitude, with a positive sign.
struct ClassOfMagnitude {
  constexpr ClassOfMagnitude() {
    for (unsigned m = 0; m <= kLongMagnitude; ++m)
      for (unsigned s = 0; s < kNibbles - 1; ++s)
        if (kResidualClasses[s].sign == 0 && static_cast<unsigned>(kResidualClasses[s].base) <= m)
          symbol[m] = static_cast<std::uint8_t>(s);
  }
  std::uint8_t symbol[kLongMagnitude + 1] = {};
};
inline constexpr ClassOfMagnitude kClassOfMagnitude;

/// The number of times that each symbol occurs. InitialModels are made from these numbers.
struct SymbolCounts {
  std::array<std::array<std::uint64_t, kNibbles>, kContexts> residuals{};
  std::array<std::uint64_t, kNibbles> longs{};
};

/// A residual, converted to a symbol and the bits that follow it.
struct ClassedResidual {
  [[gnu::always_inline]] ClassedResidual(std::uint32_t magnitude, bool negative) {
    const unsigned positive = kClassOfMagnitude.symbol[std::min(magnitude, kLongMagnitude)];
    const ResidualClass& c = kResidualClasses[positive];
    is_long = magnitude >= kLongMagnitude;
    rest = magnitude - kLongMagnitude;
    low = is_long ? 0 : magnitude - static_cast<std::uint32_t>(c.base);
    bits = static_cast<unsigned>(c.bits);
    symbol = positive + (magnitude != 0 && negative ? 1U : 0U);
  }
  unsigned symbol;
  unsigned bits;
  std::uint32_t low;   // the plain bits
  std::uint32_t rest;  // magnitude - kLongMagnitude, if is_long
  bool is_long;
};

/// Codes the part of long magnitudes that exceeds kLongMagnitude.
class LongModel {
 public:
  void Reset(const NibbleModel& start) { model_ = start; }
  /// Returns the symbol of `rest`, which is its bit length, but at most kLongest.
  static unsigned SymbolOf(std::uint32_t rest) { return std::min(BitLength(rest), kLongest); }
  /// Codes the length together with as many lower bits as allowed, then the remaining bits alone.
  void Encode(std::uint32_t rest, unsigned lane, RansEncoder::Writer* writer) {
    const unsigned length = SymbolOf(rest);
    const unsigned bits = PlainBits(length);
    const unsigned low = std::min(bits, kMaxJointBits);
    rest &= (1U << bits) - 1;
    writer->Put(lane, length, &model_, rest & ((1U << low) - 1), low);
    if (bits > low) writer->PutBits(lane, rest >> low, bits - low);
  }
  std::int32_t Decode(unsigned lane, RansDecoder* decoder) {
    const unsigned length = decoder->Get(lane, &model_);
    const unsigned bits = PlainBits(length);
    const unsigned low = std::min(bits, kMaxJointBits);
    std::uint32_t rest = decoder->GetBits(lane, low);
    if (bits > low) rest |= decoder->GetBits(lane, bits - low) << low;
    if (length > 0 && length < kLongest) rest |= 1U << (length - 1);
    return static_cast<std::int32_t>(rest);
  }

 private:
  static constexpr unsigned kLongest = 15;
  static constexpr unsigned kLongestBits = 28;

  static unsigned BitLength(std::uint32_t v) {
    return v == 0 ? 0 : 32 - static_cast<unsigned>(__builtin_clz(v));
  }
  /// Returns the number of bits that are written for a number of `length` bits. Its highest bit is
  /// not written, unless the length is kLongest.
  static unsigned PlainBits(unsigned length) {
    if (length == kLongest) return kLongestBits;
    return length > 0 ? length - 1 : 0;
  }

  NibbleModel model_;
};

/// Codes residuals, each as a symbol and some plain bits. Only long residuals take another path.
/// They are rare, so a processor mispredicts hardly any jump.
class SymbolModel {
 public:
  /// The largest number of pieces that a residual adds to a RansEncoder.
  static constexpr std::size_t kMostPieces = 3;

  void Reset(const InitialModels& start) {
    models_.fill(start.residuals);
    long_model_.Reset(start.longs);
  }

  [[gnu::always_inline]] void Encode(const Residual& residual, unsigned context, unsigned lane,
                                     RansEncoder::Writer* writer) {
    const ClassedResidual coded(static_cast<std::uint32_t>(residual.magnitude), residual.sign != 0);
    writer->Put(lane, coded.symbol, &models_[lane][context], coded.low, coded.bits);
    if (coded.is_long) long_model_.Encode(coded.rest, lane, writer);
  }

  /// Counts the symbols that Encode() would write.
  static void Count(const Residual& residual, unsigned context, SymbolCounts* counts) {
    const ClassedResidual coded(static_cast<std::uint32_t>(residual.magnitude), residual.sign != 0);
    ++counts->residuals[context][coded.symbol];
    if (coded.is_long) ++counts->longs[LongModel::SymbolOf(coded.rest)];
  }

  [[gnu::always_inline]] Residual Decode(unsigned context, unsigned lane, RansDecoder* decoder) {
    const unsigned symbol = decoder->Get(lane, &models_[lane][context]);
    const ResidualClass& c = kResidualClasses[symbol];
    const std::uint32_t low = decoder->GetBits(lane, static_cast<unsigned>(c.bits), c.mask);
    std::int32_t magnitude = static_cast<std::int32_t>(low) + c.base;
    if (__builtin_expect(symbol >= kFirstLongSymbol, 0))
      magnitude += long_model_.Decode(lane, decoder);
    return {magnitude, c.sign};
  }

 private:
  std::array<std::array<NibbleModel, kContexts>, kRansLanes> models_;
  LongModel long_model_;
};

}  // namespace lidar::codec
