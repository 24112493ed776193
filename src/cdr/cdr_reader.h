// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads a CDR message. CDR is the encoding of data in DDS, and therefore in ROS 2.
#pragma once
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>

#include "src/base/byte_reader.h"

namespace lidar::cdr {

/// Reads a message in order. After a read past the end, ok() stays false, and reads return zero or
/// nothing, as in ByteReader. The reader never allocates more memory than the size of the message.
class CdrReader {
 public:
  static constexpr std::size_t kHeaderSize = 4;
  /// The limit for names in messages: names of frames, nodes and fields.
  static constexpr std::uint32_t kMaxText = 1024;

  /// `message` begins with the encapsulation header. ok() is false unless the encoding is CDR
  /// (XCDR1) or plain CDR2, in either byte order.
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
  /// Reads a text of at most kMaxText bytes, which must end with a zero.
  std::string Text() {
    const std::uint32_t size = U32();
    const ByteView bytes = size <= kMaxText ? Bytes(size) : Fail();
    if (bytes.empty()) return {};
    ok_ = ok_ && bytes.data[bytes.size - 1] == 0;
    return ok_ ? std::string(bytes.begin(), bytes.end() - 1) : std::string();
  }
  /// Reads a sequence<octet>. The octets are not copied.
  ByteView Octets() { return Bytes(U32()); }
  /// Reads the length of a sequence whose elements have at least `least_size` bytes each. If the
  /// rest of the message is too short for so many elements, returns 0 and makes ok() false.
  std::uint32_t Count(std::size_t least_size) {
    const std::uint32_t count = U32();
    if (ok_ && count <= remaining() / least_size) return count;
    ok_ = false;
    return 0;
  }
  /// Reads an array of `n` octets.
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

  ByteView body_;  // alignment is relative to its beginning
  std::size_t position_ = 0;
  std::size_t max_alignment_ = 8;
  bool big_endian_ = false;
  bool ok_ = false;
};

}  // namespace lidar::cdr
