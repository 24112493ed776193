// SPDX-License-Identifier: LGPL-2.1-or-later
// LZF, in which PCD files are compressed.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"

namespace lidar {

/// Exactly `size` bytes; none where the data are damaged or give another size.
std::optional<std::vector<std::uint8_t>> DecompressLzf(ByteView data, std::size_t size);

}  // namespace lidar
