// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads an image that marks which pixels of a sensor are kept.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/ouster/metadata.h"

namespace lidar::ouster {

/// A byte for each pixel of a scan; pixels with the value 0 are removed. The size is beams x
/// columns_per_scan, row-major. As in packets, the rows are not destaggered.
using PixelMask = std::vector<std::uint8_t>;

/// Reads a binary PGM (P5, 8 bits) that has one pixel for each beam and column. The image must be
/// destaggered, as pictures of a scan are. Returns nothing and sets `error` for any other file.
std::optional<PixelMask> ParseMaskImage(ByteView pgm, const Metadata& metadata, std::string* error);

}  // namespace lidar::ouster
