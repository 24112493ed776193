// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/base/crc.h"

#include <lzma.h>

namespace lidar {

std::uint32_t Crc32(ByteView bytes, std::uint32_t seed) {
  return lzma_crc32(bytes.data, bytes.size, seed);
}
std::uint64_t Crc64(ByteView bytes, std::uint64_t seed) {
  return lzma_crc64(bytes.data, bytes.size, seed);
}

}  // namespace lidar
