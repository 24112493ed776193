// SPDX-License-Identifier: LGPL-2.1-or-later
// Points of CompressedPointCloud2, packed as the plugins of ROS's point_cloud_transport pack them.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "src/cdr/point_cloud2.h"

namespace lidar::gst {

enum class CloudCompression { kDraco, kZlib, kZstd };

/// The compression's name in messages.
const char* NameOf(CloudCompression compression);

/// Returns nothing for an unknown format or damaged data; `why` has the reason. Takes no more
/// memory than the layout's points need, at most 256 MiB.
std::optional<cdr::MadeCloud> Decompress(const cdr::CompressedCloud& compressed, std::string* why);

/// Packs the points without loss. Returns nothing if the compression is not built in, or cannot
/// pack the cloud. `packed` holds the result's data.
std::optional<cdr::CompressedCloud> Compress(CloudCompression compression,
                                             const cdr::PointCloud2& cloud,
                                             std::vector<std::uint8_t>* packed);

}  // namespace lidar::gst
