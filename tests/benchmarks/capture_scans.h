// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads the scans of a capture file as raw clouds.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "src/codec/cloud_io.h"

namespace lidar::bench {

struct CapturedSlice {
  std::uint32_t first_column = 0;
  std::uint32_t width = 0;
  std::vector<std::uint8_t> points;
};

struct Capture {
  codec::CloudFormat format;
  std::vector<CapturedSlice> slices;
};

/// Returns the complete scans of a capture, each cut into `slices_per_scan` slices. Returns nullopt
/// if a file cannot be read.
std::optional<Capture> ReadCapture(const std::string& pcap, const std::string& metadata,
                                   std::uint32_t slices_per_scan);

}  // namespace lidar::bench
