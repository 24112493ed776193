// SPDX-License-Identifier: LGPL-2.1-or-later
// A binary range coder without carries. It codes one bit at a time. The caller states for each bit
// the chance that the bit is 1.
#pragma once
#include <cstdint>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/codec/mixing/arithmetic.h"

namespace lidar::codec::mixing {

class BinaryEncoder {
 public:
  static constexpr bool kDecodes = false;
  /// The bytes are appended to `out`.
  explicit BinaryEncoder(std::vector<std::uint8_t>* out) : out_(out) {}

  /// Writes and returns `bit`. `chance`, the chance that a bit is 1, is from kLeastChance to
  /// kMostChance.
  bool Code(bool bit, std::int32_t chance) {
    const std::uint32_t split =
        low_ + static_cast<std::uint32_t>(
                   std::uint64_t{high_ - low_} * static_cast<std::uint32_t>(chance) >> 16);
    (bit ? high_ : low_) = bit ? split : split + 1;
    while ((low_ ^ high_) < 1U << 24) {
      out_->push_back(static_cast<std::uint8_t>(high_ >> 24));
      low_ <<= 8;
      high_ = high_ << 8 | 0xFF;
    }
    return bit;
  }
  /// Returns false, because an encoder reads nothing. Templates call overran() of encoders and
  /// decoders.
  static constexpr bool overran() { return false; }
  /// Writes the last bytes. A decoder reads zeros after them.
  void Finish();

 private:
  std::vector<std::uint8_t>* out_;
  std::uint32_t low_ = 0;
  std::uint32_t high_ = UINT32_MAX;
};

class BinaryDecoder {
 public:
  static constexpr bool kDecodes = true;
  explicit BinaryDecoder(ByteView bytes)
      : next_(bytes.data), end_(bytes.data == nullptr ? nullptr : bytes.data + bytes.size) {
    for (int i = 0; i < 4; ++i) code_ = code_ << 8 | NextByte();
  }

  /// Reads and returns a bit. The first parameter is unused. It only gives Code() the same
  /// parameters as in BinaryEncoder.
  [[gnu::always_inline]] bool Code(bool /*bit*/, std::int32_t chance) {
    const std::uint32_t split =
        low_ + static_cast<std::uint32_t>(
                   std::uint64_t{high_ - low_} * static_cast<std::uint32_t>(chance) >> 16);
    const bool bit = code_ <= split;
    // Masks replace a branch, which the processor would often predict wrongly.
    const std::uint32_t ones = bit ? UINT32_MAX : 0;
    high_ ^= (high_ ^ split) & ones;
    low_ += (split + 1 - low_) & ~ones;
    if (__builtin_expect((low_ ^ high_) < 1U << 24, 0)) Refill();
    return bit;
  }
  /// Returns true if bits were read past the end of the bytes.
  bool overran() const { return missing_ > 4; }
  /// Returns true if all bytes were read, and no bits past their end.
  bool AtEnd() const { return next_ == end_ && !overran(); }

 private:
  void Refill();
  std::uint32_t NextByte() {
    if (next_ != end_) return *next_++;
    ++missing_;
    return 0;
  }

  const std::uint8_t* next_;
  const std::uint8_t* end_;
  std::uint32_t missing_ = 0;
  std::uint32_t low_ = 0;
  std::uint32_t high_ = UINT32_MAX;
  std::uint32_t code_ = 0;
};

}  // namespace lidar::codec::mixing
