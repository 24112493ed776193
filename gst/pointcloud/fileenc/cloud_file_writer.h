// SPDX-License-Identifier: LGPL-2.1-or-later
// Writes clouds as PCD files (Point Cloud Library) and PLY files.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "gst/lidar/cloud_info.h"

namespace lidar::gst {

struct CloudFileInput {
  const CloudInfo* info = nullptr;
  const std::uint8_t* points = nullptr;      // info->FrameSize() bytes
  std::optional<GstClockTime> capture_time;  // [ns since the Unix epoch]; written as a comment
  bool binary = true;
};

/// Writes PCD 0.7. In an organised cloud a point without a return is NaN, as in PCL. In an
/// unorganised cloud it is omitted.
std::string WritePcd(const CloudFileInput& cloud);
/// Writes PLY 1.0 and omits points without a return.
std::string WritePly(const CloudFileInput& cloud);

}  // namespace lidar::gst
