// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads an unchecked CDR message, the form of data in DDS and so in ROS 2.
#pragma once
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>

#include "src/base/byte_reader.h"

namespace lidar::cdr {

/// Reads in order. A read past the end gives zero or nothing and makes ok() false for good, as
/// ByteReader does. It never allocates more than the message is long.
class CdrReader {
 public:
  static constexpr std::size_t kHeaderSize = 4;
  /// Names in messages: frames, nodes, fields.
  static constexpr std::uint32_t kMaxText = 1024;

  /// `message` begins with the encapsulation header: CDR (XCDR1) or plain CDR2 of either byte
  /// order. Anything else is not ok.
  explicit CdrReader(ByteView message) : body_(message.Sub(kHeaderSize)) {
    const bool known = message.size >= kHeaderSize && message.data[0] == 0 &&
                       (message.data[1] <= 1 || message.data[1] == 6 || message.data[1] == 7);
    ok_ = known;
    if (!known) return;
    big_endian_ = (message.data[1] & 1) == 0;
    max_alignment_ = message.data[1] >= 6 ? 4 : 8;
  }

  bool ok() const { return ok_; }
  std::size_t remaining() const { return body_.size - position_; }

  std::uint8_t U8() { return static_cast<std::uint8_t>(Unsigned(1)); }
  bool Bool() { return U8() != 0; }
  std::uint32_t U32() { return static_cast<std::uint32_t>(Unsigned(4)); }
  std::int32_t I32() { return static_cast<std::int32_t>(U32()); }
  std::uint64_t U64() { return Unsigned(8); }
  float F32() {
    const std::uint32_t bits = U32();
    float value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  double F64() {
    const std::uint64_t bits = Unsigned(8);
    double value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  template <class Array>
  void F64s(Array* values) {
    for (double& value : *values) value = F64();
  }
  /// At most kMaxText bytes, which end with a zero.
  std::string Text() {
    const std::uint32_t size = U32();
    const ByteView bytes = size <= kMaxText ? Bytes(size) : Fail();
    if (bytes.empty()) return {};
    ok_ = ok_ && bytes.data[bytes.size - 1] == 0;
    return ok_ ? std::string(bytes.begin(), bytes.end() - 1) : std::string();
  }
  /// sequence<octet>, not copied.
  ByteView Octets() { return Bytes(U32()); }
  /// The length of a sequence of elements with at least `least_size` bytes each: 0 and not ok if
  /// the rest of the message cannot hold so many elements.
  std::uint32_t Count(std::size_t least_size) {
    const std::uint32_t count = U32();
    if (ok_ && count <= remaining() / least_size) return count;
    ok_ = false;
    return 0;
  }
  /// An array of octets.
  ByteView Bytes(std::size_t n) {
    if (!Has(n)) return {};
    position_ += n;
    return {body_.data + position_ - n, n};
  }

 private:
  ByteView Fail() {
    ok_ = false;
    return {};
  }
  bool Has(std::size_t n) {
    ok_ = ok_ && n <= remaining();
    return ok_;
  }
  std::uint64_t Unsigned(std::size_t size) {
    const std::size_t alignment = std::min(size, max_alignment_);
    const std::size_t padding = (alignment - position_ % alignment) % alignment;
    if (!Has(padding + size)) return 0;
    position_ += padding;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i)
      value |= std::uint64_t{body_.data[position_ + i]} << 8 * (big_endian_ ? size - 1 - i : i);
    position_ += size;
    return value;
  }

  ByteView body_;  // alignment counts from its beginning
  std::size_t position_ = 0;
  std::size_t max_alignment_ = 8;
  bool big_endian_ = false;
  bool ok_ = false;
};

}  // namespace lidar::cdr
