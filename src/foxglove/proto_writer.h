// SPDX-License-Identifier: LGPL-2.1-or-later
// Appends fields of protobuf messages to a growing vector of bytes.
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

#include "src/base/byte_writer.h"

namespace lidar::foxglove {

class ProtoWriter {
 public:
  /// Appends to `out`, which must outlive this object.
  explicit ProtoWriter(std::vector<std::uint8_t>* out) : out_(*out), bytes_(out) {}

  void Varint(std::uint32_t field, std::uint64_t value) {
    Tag(field, kVarint);
    RawVarint(value);
  }
  void Fixed32(std::uint32_t field, std::uint32_t value) {
    Tag(field, kFixed32);
    bytes_.Le32(value);
  }
  void Double(std::uint32_t field, double value) {
    Tag(field, kFixed64);
    bytes_.LeF64(value);
  }
  void String(std::uint32_t field, std::string_view text) {
    BeginBytes(field, text.size());
    out_.insert(out_.end(), text.begin(), text.end());
  }
  void Bytes(std::uint32_t field, ByteView bytes) {
    BeginBytes(field, bytes.size);
    bytes_.Bytes(bytes);
  }
  /// Begins a field of bytes. The caller must append `size` bytes next.
  void BeginBytes(std::uint32_t field, std::size_t size) {
    Tag(field, kLength);
    RawVarint(size);
  }
  /// Appends a field that is a message. `write` writes the fields of this message.
  template <class Write>
  void Message(std::uint32_t field, const Write& write) {
    std::vector<std::uint8_t> inner;
    ProtoWriter writer(&inner);
    write(writer);
    Bytes(field, {inner.data(), inner.size()});
  }

 private:
  enum Wire : std::uint32_t { kVarint = 0, kFixed64 = 1, kLength = 2, kFixed32 = 5 };

  void Tag(std::uint32_t field, Wire wire) { RawVarint(std::uint64_t{field} << 3 | wire); }
  void RawVarint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) bytes_.U8(static_cast<std::uint8_t>(value | 0x80));
    bytes_.U8(static_cast<std::uint8_t>(value));
  }

  std::vector<std::uint8_t>& out_;
  ByteWriter bytes_;
};

}  // namespace lidar::foxglove
