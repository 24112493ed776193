// SPDX-License-Identifier: LGPL-2.1-or-later
// How a coded slice hangs together with others, read without decoding it.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"

namespace lidar::codec {

/// A block that others may refer to, or that refers to another.
struct BlockName {
  std::uint32_t crc = 0;                   // of the whole block: its name
  std::optional<std::uint32_t> reference;  // the name of the block that it needs
};

/// The blocks of a slice in range geometry, without those that hang together with no other. None
/// for bytes that no decoder takes; bytes that are taken here may still be refused by one.
std::optional<std::vector<BlockName>> LinksOf(ByteView slice);

}  // namespace lidar::codec
