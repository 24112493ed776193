// SPDX-License-Identifier: LGPL-2.1-or-later
// Clouds as PCD (Point Cloud Library) and PLY files.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "gst/lidar/cloud_info.h"

namespace lidar::gst {

struct CloudFileInput {
  const CloudInfo* info = nullptr;
  const std::uint8_t* points = nullptr;      // info->FrameSize() bytes
  std::optional<GstClockTime> capture_time;  // [ns since the Unix epoch], kept as a comment
  bool binary = true;
};

/// PCD 0.7. A point without a return is NaN in an organised cloud, as in PCL, and left out of an
/// unorganised cloud.
std::string WritePcd(const CloudFileInput& cloud);
/// PLY 1.0, without the points that have no return.
std::string WritePly(const CloudFileInput& cloud);

}  // namespace lidar::gst
