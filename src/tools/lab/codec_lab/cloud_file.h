// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads clouds from files: KITTI's .bin, PCD and PLY.
#pragma once
#include <string>

#include "src/tools/lab/codec_lab/scan.h"

namespace lidar::tools {

/// Returns true if the extension of the name is that of a cloud.
bool IsCloudFile(const std::string& path);
/// Reads a cloud. Leaves out points that are not finite, and points whose coordinates are all 0.
/// Throws std::runtime_error if the file cannot be read.
Scan ReadCloud(const std::string& path);

}  // namespace lidar::tools
