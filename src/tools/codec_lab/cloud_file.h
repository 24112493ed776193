// SPDX-License-Identifier: LGPL-2.1-or-later
// Clouds in files: KITTI's .bin and PCD.
#pragma once
#include <string>

#include "src/tools/codec_lab/scan.h"

namespace lidar::tools {

/// Points that are all zero or not finite are left out. Throw std::runtime_error.
Scan ReadBin(const std::string& path);
Scan ReadPcd(const std::string& path);

}  // namespace lidar::tools
