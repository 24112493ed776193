// SPDX-License-Identifier: LGPL-2.1-or-later
// Functions for the bytes that tests of messages write and read.
#pragma once
#include <cstdint>
#include <vector>

#include "src/base/byte_reader.h"

namespace lidar::cdr {

using Bytes = std::vector<std::uint8_t>;

inline ByteView View(const Bytes& bytes) { return {bytes.data(), bytes.size()}; }

}  // namespace lidar::cdr
