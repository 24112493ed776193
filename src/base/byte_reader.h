// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads integers from bytes that may be too short.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace lidar {

/// A view of bytes that other objects own (std::span is C++20).
struct ByteView {
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;

  const std::uint8_t* begin() const { return data; }
  const std::uint8_t* end() const { return data + size; }
  bool empty() const { return size == 0; }
  /// Returns `n` bytes from `offset` on, or fewer if the view ends before.
  ByteView Sub(std::size_t offset, std::size_t n = SIZE_MAX) const {
    if (offset > size) offset = size;
    const std::size_t left = size - offset;
    return {data + offset, n < left ? n : left};
  }
};

/// Reads bytes in order. After a read past the end, ok() stays false, and reads return zero. A
/// parser may therefore read a whole header and check ok() once at the end.
class ByteReader {
 public:
  explicit ByteReader(ByteView bytes) : bytes_(bytes) {}
  ByteReader(const std::uint8_t* data, std::size_t size) : bytes_{data, size} {}

  bool ok() const { return ok_; }
  std::size_t position() const { return position_; }
  std::size_t remaining() const { return bytes_.size - position_; }

  std::uint8_t U8() { return static_cast<std::uint8_t>(Big(1)); }
  std::uint16_t Be16() { return static_cast<std::uint16_t>(Big(2)); }
  std::uint32_t Be24() { return static_cast<std::uint32_t>(Big(3)); }
  std::uint32_t Be32() { return static_cast<std::uint32_t>(Big(4)); }
  std::uint64_t Be64() { return Big(8); }
  std::uint16_t Le16() { return static_cast<std::uint16_t>(Little(2)); }
  std::uint32_t Le24() { return static_cast<std::uint32_t>(Little(3)); }
  std::uint32_t Le32() { return static_cast<std::uint32_t>(Little(4)); }
  std::uint64_t Le40() { return Little(5); }
  std::uint64_t Le64() { return Little(8); }
  float LeF32() {
    const std::uint32_t bits = Le32();
    float f = 0;
    std::memcpy(&f, &bits, sizeof f);
    return f;
  }
  double LeF64() {
    const std::uint64_t bits = Le64();
    double d = 0;
    std::memcpy(&d, &bits, sizeof d);
    return d;
  }
  /// Returns the next `n` bytes. If there are fewer bytes, returns none and makes ok() false.
  ByteView Bytes(std::size_t n) {
    if (!Has(n)) return {};
    const ByteView v{bytes_.data + position_, n};
    position_ += n;
    return v;
  }
  void Skip(std::size_t n) { Bytes(n); }
  ByteView Rest() { return Bytes(remaining()); }

 private:
  bool Has(std::size_t n) {
    ok_ = ok_ && n <= remaining();
    return ok_;
  }
  std::uint64_t Big(unsigned n) {
    std::uint64_t v = 0;
    if (Has(n))
      for (; n > 0; --n) v = v << 8 | bytes_.data[position_++];
    return v;
  }
  std::uint64_t Little(unsigned n) {
    std::uint64_t v = 0;
    if (Has(n))
      for (unsigned i = 0; i < n; ++i)
        v |= static_cast<std::uint64_t>(bytes_.data[position_++]) << (8 * i);
    return v;
  }

  ByteView bytes_;
  std::size_t position_ = 0;
  bool ok_ = true;
};

}  // namespace lidar
