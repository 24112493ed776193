// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads clouds from recordings. They are PointCloud2 messages in MCAP files and in bags.
#pragma once
#include <memory>
#include <string>

#include "src/tools/lab/codec_lab/scan_source.h"

namespace lidar::tools {

/// Opens the clouds of `topic`. If `topic` is empty, opens those of the only topic that has clouds.
/// Leaves out damaged messages. Throws std::runtime_error with a message for the user.
std::unique_ptr<ScanStream> OpenRecording(const std::string& path, const std::string& topic);

}  // namespace lidar::tools
