// SPDX-License-Identifier: LGPL-2.1-or-later
// Caps of encoded clouds to stream configs and back.
#pragma once
#include <gst/gst.h>

#include <optional>

#include "gst/common/gstlidar.h"
#include "src/rtp/stream_config.h"

/// What can be sent: the slices of each coder.
#define GST_LIDAR_CODED_CAPS                                                             \
  GST_LIDAR_SLICE_MEDIA_TYPE                                                             \
  ", alignment = (string) slice, geometry = (string) range; " GST_LIDAR_DRACO_MEDIA_TYPE \
  ", alignment = (string) slice, geometry = (string) { xyz, range }"

namespace lidar::gst {

/// None where a field is missing, does not parse, or contradicts another.
std::optional<rtp::StreamConfig> StreamConfigFromCaps(const GstCaps* caps);
/// transfer full
GstCaps* StreamConfigToCaps(const rtp::StreamConfig& config);

}  // namespace lidar::gst
