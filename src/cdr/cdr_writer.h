// SPDX-License-Identifier: LGPL-2.1-or-later
// Writes a CDR message (XCDR1, little-endian). CDR is the encoding of data in DDS, and therefore in
// ROS 2.
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

#include "src/base/byte_writer.h"

namespace lidar::cdr {

class CdrWriter {
 public:
  /// Writes the header of a message at the end of `out`, which must outlive this object.
  explicit CdrWriter(std::vector<std::uint8_t>* out) : writer_(out) {
    writer_.Be32(0x0001'0000);  // CDR_LE, no options
    body_ = writer_.size();
  }

  void U8(std::uint8_t v) { writer_.U8(v); }
  void Bool(bool v) { writer_.U8(v ? 1 : 0); }
  void U32(std::uint32_t v) {
    Align(4);
    writer_.Le32(v);
  }
  void I32(std::int32_t v) { U32(static_cast<std::uint32_t>(v)); }
  void U64(std::uint64_t v) {
    Align(8);
    writer_.Le64(v);
  }
  void F32(float v) {
    Align(4);
    writer_.LeF32(v);
  }
  void F64(double v) {
    Align(8);
    writer_.LeF64(v);
  }
  template <class Array>
  void F64s(const Array& values) {
    for (const double value : values) F64(value);
  }
  void Text(std::string_view text) {
    U32(static_cast<std::uint32_t>(text.size() + 1));
    for (const char c : text) U8(static_cast<std::uint8_t>(c));
    U8(0);
  }
  /// Writes an array of octets.
  void Bytes(ByteView bytes) { writer_.Bytes(bytes); }
  /// Writes a sequence<octet>.
  void Octets(ByteView bytes) {
    U32(static_cast<std::uint32_t>(bytes.size));
    Bytes(bytes);
  }

 private:
  void Align(std::size_t alignment) {
    const std::size_t over = (writer_.size() - body_) % alignment;
    if (over > 0) writer_.Zeros(alignment - over);
  }

  ByteWriter writer_;
  std::size_t body_ = 0;  // alignment is relative to this offset
};

}  // namespace lidar::cdr
