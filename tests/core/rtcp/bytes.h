// SPDX-License-Identifier: LGPL-2.1-or-later
// The type of packets in the tests of RTCP.
#pragma once
#include <cstdint>
#include <vector>

#include "src/base/byte_reader.h"

namespace lidar::rtcp {

using Bytes = std::vector<std::uint8_t>;

inline ByteView View(const Bytes& bytes) { return {bytes.data(), bytes.size()}; }

}  // namespace lidar::rtcp
