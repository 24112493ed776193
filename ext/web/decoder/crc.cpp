// SPDX-License-Identifier: LGPL-2.1-or-later
// Implements src/base/crc.h without liblzma, which is not built for WebAssembly.
#include "src/base/crc.h"

#include <array>

namespace lidar {
namespace {

constexpr std::array<std::uint32_t, 256> MakeTable() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    std::uint32_t rest = i;
    for (int bit = 0; bit < 8; ++bit) rest = rest >> 1 ^ ((rest & 1) != 0 ? 0xEDB88320U : 0);
    table[i] = rest;
  }
  return table;
}
constexpr auto kCrcTable = MakeTable();

}  // namespace

std::uint32_t Crc32(ByteView bytes, std::uint32_t seed) {
  std::uint32_t crc = ~seed;
  for (std::size_t i = 0; i < bytes.size; ++i)
    crc = kCrcTable[(crc ^ bytes.data[i]) & 255] ^ crc >> 8;
  return ~crc;
}

}  // namespace lidar
