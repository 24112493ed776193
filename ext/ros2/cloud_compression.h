// SPDX-License-Identifier: LGPL-2.1-or-later
// Compresses and decompresses the points of CompressedPointCloud2, as the plugins of ROS's
// point_cloud_transport do.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "src/cdr/point_cloud2.h"

namespace lidar::gst {

enum class CloudCompression { kDraco, kZlib, kZstd };

/// Returns the name that messages have for the compression.
const char* NameOf(CloudCompression compression);

/// Decompresses a cloud. Returns nothing and sets `why` if the format is unknown or the data are
/// damaged. Uses no more memory than the points of the layout need, and at most 256 MiB.
std::optional<cdr::MadeCloud> Decompress(const cdr::CompressedCloud& compressed, std::string* why);

/// Compresses the points without loss. The data of the result are in `packed`. Returns nothing if
/// the compression is not built in, or if it cannot compress the cloud.
std::optional<cdr::CompressedCloud> Compress(CloudCompression compression,
                                             const cdr::PointCloud2& cloud,
                                             std::vector<std::uint8_t>* packed);

}  // namespace lidar::gst
