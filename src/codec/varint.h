// SPDX-License-Identifier: LGPL-2.1-or-later
// Writes and reads numbers below 2^28 as LEB128: seven bits per byte, the lowest bits first, and at
// most four bytes.
#pragma once
#include <cstdint>

#include "src/base/byte_reader.h"
#include "src/base/byte_writer.h"

namespace lidar::codec {

inline void WriteVarint(std::uint32_t value, ByteWriter* writer) {
  for (; value >= 0x80; value >>= 7) writer->U8(static_cast<std::uint8_t>(value | 0x80));
  writer->U8(static_cast<std::uint8_t>(value));
}

/// Returns the next number of `reader`. Sets `*ok` to false if the number has more than four bytes.
inline std::uint32_t ReadVarint(ByteReader* reader, bool* ok) {
  std::uint32_t value = 0;
  for (unsigned shift = 0; shift < 28; shift += 7) {
    const std::uint8_t byte = reader->U8();
    value |= (byte & 0x7FU) << shift;
    if (byte < 0x80) return value;
  }
  *ok = false;
  return 0;
}

}  // namespace lidar::codec
