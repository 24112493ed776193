// SPDX-License-Identifier: LGPL-2.1-or-later
// Clouds in recordings: PointCloud2 messages of MCAP files and of bags.
#pragma once
#include <memory>
#include <string>

#include "src/tools/lab/codec_lab/scan_source.h"

namespace lidar::tools {

/// The clouds of `topic`; empty: of the only topic with clouds. A message that is damaged is left
/// out. Throws std::runtime_error with a message for the user.
std::unique_ptr<ScanStream> OpenRecording(const std::string& path, const std::string& topic);

}  // namespace lidar::tools
