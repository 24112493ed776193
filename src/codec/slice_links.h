// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds out to which blocks a coded slice refers, without decoding the slice.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"

namespace lidar::codec {

/// A block of kTemporal. Other blocks may refer to it, and it may refer to another block.
struct BlockName {
  std::uint32_t crc = 0;                   // name of the block: CRC of the block
  std::optional<std::uint32_t> reference;  // name of the block to which it refers
};

/// Returns those blocks of `slice` that are of kTemporal. The slice must be in range geometry.
/// Returns nothing for bytes that every decoder refuses. A decoder may refuse other slices, too.
std::optional<std::vector<BlockName>> LinksOf(ByteView slice);

}  // namespace lidar::codec
