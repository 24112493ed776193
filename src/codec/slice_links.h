// SPDX-License-Identifier: LGPL-2.1-or-later
// References of a coded slice, read without decoding it.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"

namespace lidar::codec {

/// A block that others may refer to, or that refers to another.
struct BlockName {
  std::uint32_t crc = 0;                   // name of the block: CRC over it
  std::optional<std::uint32_t> reference;  // name of the block that it needs
};

/// Returns the blocks of a slice in range geometry that have links. Returns nothing for bytes that
/// every decoder refuses; a decoder may refuse others, too.
std::optional<std::vector<BlockName>> LinksOf(ByteView slice);

}  // namespace lidar::codec
