// SPDX-License-Identifier: LGPL-2.1-or-later
// The header of a coded cloud (docs/cloud-coder.md).
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/codec/cloud/cell_cover.h"
#include "src/codec/intensity_scale.h"

namespace lidar::codec::cloud {

struct CloudHeader {
  bool has_beams = false;        // a beam section follows the far points
  bool has_exact_part = false;   // fields or an order follow the cells
  IntensityScale intensity;      // 0 bits: geometry only
  std::uint32_t points = 0;      // in cells
  std::uint32_t far_points = 0;  // past the largest grid
  CellGrid grid;
  unsigned depth = 1;
  std::uint32_t stream_size = 0;  // bytes of the cells

  void Write(std::vector<std::uint8_t>* out) const;
  /// Returns nothing for another version and for numbers that no encoder writes.
  static std::optional<CloudHeader> Read(ByteReader* reader);
};

/// Most nodes that a slice of `slice_bytes` may have. A node costs a decoder a microsecond, but its
/// sender perhaps a hundredth of a bit.
constexpr std::size_t MostNodes(std::size_t slice_bytes) {
  constexpr std::size_t kFree = 4'096;
  constexpr std::size_t kNodesPerByte = 64;
  return kFree + kNodesPerByte * slice_bytes;
}

}  // namespace lidar::codec::cloud
