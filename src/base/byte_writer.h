// SPDX-License-Identifier: LGPL-2.1-or-later
// Appends integers to a growing vector of bytes.
#pragma once
#include <cstdint>
#include <cstring>
#include <vector>

#include "src/base/byte_reader.h"

namespace lidar {

class ByteWriter {
 public:
  /// Appends to `out`, which must outlive this object.
  explicit ByteWriter(std::vector<std::uint8_t>* out) : out_(*out) {}

  std::size_t size() const { return out_.size(); }
  void U8(std::uint8_t v) { out_.push_back(v); }
  void Be16(std::uint16_t v) { Big(v, 2); }
  void Be24(std::uint32_t v) { Big(v, 3); }
  void Be32(std::uint32_t v) { Big(v, 4); }
  void Be64(std::uint64_t v) { Big(v, 8); }
  void Le16(std::uint16_t v) { Little(v, 2); }
  void Le24(std::uint32_t v) { Little(v, 3); }
  void Le32(std::uint32_t v) { Little(v, 4); }
  void Le40(std::uint64_t v) { Little(v, 5); }
  void Le64(std::uint64_t v) { Little(v, 8); }
  void LeF32(float f) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &f, sizeof bits);
    Le32(bits);
  }
  void LeF64(double d) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &d, sizeof bits);
    Le64(bits);
  }
  void Bytes(ByteView v) { out_.insert(out_.end(), v.begin(), v.end()); }
  void Zeros(std::size_t n) { out_.insert(out_.end(), n, 0); }

 private:
  void Big(std::uint64_t v, unsigned n) {
    for (; n > 0; --n) out_.push_back(static_cast<std::uint8_t>(v >> (8 * (n - 1))));
  }
  void Little(std::uint64_t v, unsigned n) {
    for (unsigned i = 0; i < n; ++i) out_.push_back(static_cast<std::uint8_t>(v >> (8 * i)));
  }
  std::vector<std::uint8_t>& out_;
};

}  // namespace lidar
