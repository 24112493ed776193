// SPDX-License-Identifier: LGPL-2.1-or-later
// Represents points by the occupied cells of a cubic grid, and by the number of points in each
// cell.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace lidar::codec::cloud {

/// The largest depth of a grid. A grid has 2^depth cells along each axis. The sensor is in the
/// middle, where eight cells meet.
constexpr unsigned kMostDepth = 21;

using CellPosition = std::array<std::uint32_t, 3>;  // from 0 to 2^depth - 1

/// The occupied cells of a grid, in the order of their Morton codes.
struct CellList {
  unsigned depth = 1;
  std::vector<std::uint64_t> codes;
  std::vector<std::uint32_t> counts;  // number of points in each cell; at least 1

  /// Adds a point in the cell with this code. Points must be added in the order of their codes.
  void AddPoint(std::uint64_t code) {
    if (codes.empty() || codes.back() != code) {
      codes.push_back(code);
      counts.push_back(0);
    }
    ++counts.back();
  }
  void Clear() {
    codes.clear();
    counts.clear();
  }
};

/// Returns the lowest 21 bits of `v`, spread over 63 bits. Bit i is moved to bit 3 i of a Morton
/// code.
inline std::uint64_t SpreadBits(std::uint64_t v) {
  v &= 0x1FFFFF;
  v = (v | v << 32) & 0x1F00000000FFFF;
  v = (v | v << 16) & 0x1F0000FF0000FF;
  v = (v | v << 8) & 0x100F00F00F00F00F;
  v = (v | v << 4) & 0x10C30C30C30C30C3;
  v = (v | v << 2) & 0x1249249249249249;
  return v;
}
inline std::uint32_t GatherBits(std::uint64_t v) {
  v &= 0x1249249249249249;
  v = (v | v >> 2) & 0x10C30C30C30C30C3;
  v = (v | v >> 4) & 0x100F00F00F00F00F;
  v = (v | v >> 8) & 0x1F0000FF0000FF;
  v = (v | v >> 16) & 0x1F00000000FFFF;
  v = (v | v >> 32) & 0x1FFFFF;
  return static_cast<std::uint32_t>(v);
}
inline std::uint64_t MortonCode(const CellPosition& p) {
  return SpreadBits(p[0]) | SpreadBits(p[1]) << 1 | SpreadBits(p[2]) << 2;
}
inline CellPosition PositionOf(std::uint64_t code) {
  return {GatherBits(code), GatherBits(code >> 1), GatherBits(code >> 2)};
}

}  // namespace lidar::codec::cloud
