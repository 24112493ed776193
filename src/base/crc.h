// SPDX-License-Identifier: LGPL-2.1-or-later
// Checksums: CRC-32 (IEEE 802.3) for slices, and CRC-64/XZ for Ouster packets.
#pragma once
#include <cstdint>

#include "src/base/byte_reader.h"

namespace lidar {

/// Returns the CRC-32 of `bytes`. A CRC can be computed in parts: `seed` is the CRC of the bytes
/// before `bytes`.
std::uint32_t Crc32(ByteView bytes, std::uint32_t seed = 0);
/// Returns the CRC-64 of `bytes`. The polynomial is reflected 0xC96C5795D7870F42, and the initial
/// value and the final XOR are all ones.
std::uint64_t Crc64(ByteView bytes, std::uint64_t seed = 0);

}  // namespace lidar
