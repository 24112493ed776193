// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads the scans that a command line names: captures, cloud files and synthetic drives.
#pragma once
#include <string>
#include <vector>

#include "src/tools/codec_lab/scan.h"

namespace lidar::tools {

struct SourceOptions {
  std::size_t max_scans = 20;  // of each source
  double speed_mps = 10;       // of synthetic drives
  std::uint64_t seed = 0;      // of synthetic drives
};

/// `text` is one of
///   drive.pcap             an Ouster capture; its metadata is drive.json beside it
///   drive.pcap,sensor.json the same with another metadata file
///   cloud.bin, cloud.pcd   a cloud (KITTI's x y z intensity floats; PCD in ascii or binary)
///   folder                 consecutive clouds in such files, by name
///   synth:os1-64:street    a synthetic sensor in street, tunnel or field; a third part is the
///                          number of columns (1024)
/// Throws std::runtime_error with a message for the user.
ScanSet LoadScans(const std::string& text, const SourceOptions& options);
std::vector<ScanSet> LoadAllScans(const std::vector<std::string>& texts,
                                  const SourceOptions& options);

extern const char* const kSourceHelp;

}  // namespace lidar::tools
