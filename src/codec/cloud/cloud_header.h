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
  bool has_exact_part = false;   // an exact section follows the cells
  IntensityScale intensity;      // with 0 bits, only geometry is coded
  std::uint32_t points = 0;      // points in cells
  std::uint32_t far_points = 0;  // points outside of the largest grid
  CellGrid grid;
  unsigned depth = 1;
  std::uint32_t stream_size = 0;  // size of the stream of the cells

  void Write(std::vector<std::uint8_t>* out) const;
  /// Reads a header. Returns nothing if the version is unknown, or if a number is one that no
  /// encoder writes.
  static std::optional<CloudHeader> Read(ByteReader* reader);
};

/// Returns the largest number of nodes in a slice of `slice_bytes`. A limit is needed because a
/// node takes a decoder a microsecond, although a sender may need only a hundredth of a bit for it.
constexpr std::size_t MostNodes(std::size_t slice_bytes) {
  constexpr std::size_t kFree = 4'096;
  constexpr std::size_t kNodesPerByte = 64;
  return kFree + kNodesPerByte * slice_bytes;
}

}  // namespace lidar::codec::cloud
