// SPDX-License-Identifier: LGPL-2.1-or-later
// Clouds in files: KITTI's .bin, PCD and PLY.
#pragma once
#include <string>

#include "src/tools/lab/codec_lab/scan.h"

namespace lidar::tools {

/// Decides by the end of the name.
bool IsCloudFile(const std::string& path);
/// Points that are all zero or not finite are left out. Throws std::runtime_error.
Scan ReadCloud(const std::string& path);

}  // namespace lidar::tools
