// SPDX-License-Identifier: LGPL-2.1-or-later
// An image that marks the pixels of a sensor to keep.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/ouster/metadata.h"

namespace lidar::ouster {

/// A byte for each pixel; pixels with 0 are left out. Beams x columns_per_scan, row-major, as
/// packets have them.
using PixelMask = std::vector<std::uint8_t>;

/// Reads a binary PGM (P5, 8 bit) of one pixel a beam and column, destaggered as pictures of a scan
/// are. Returns nothing and sets `error` for anything else.
std::optional<PixelMask> ParseMaskImage(ByteView pgm, const Metadata& metadata, std::string* error);

}  // namespace lidar::ouster
