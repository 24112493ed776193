// SPDX-License-Identifier: LGPL-2.1-or-later
// Checksums: CRC-32 (IEEE 802.3) of slices, CRC-64/XZ of Ouster packets.
#pragma once
#include <cstdint>

#include "src/base/byte_reader.h"

namespace lidar {

/// `seed` is the CRC of the preceding bytes, so that a CRC can be computed in parts.
std::uint32_t Crc32(ByteView bytes, std::uint32_t seed = 0);
/// Reflected 0xC96C5795D7870F42, initial value and final XOR all ones.
std::uint64_t Crc64(ByteView bytes, std::uint64_t seed = 0);

}  // namespace lidar
