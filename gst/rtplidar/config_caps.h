// SPDX-License-Identifier: LGPL-2.1-or-later
// Caps of encoded clouds to stream configs and back.
#pragma once
#include <gst/gst.h>

#include <optional>

#include "src/rtp/stream_config.h"

namespace lidar::gst {

/// None where a field is missing, does not parse, or contradicts another.
std::optional<rtp::StreamConfig> StreamConfigFromCaps(const GstCaps* caps);
/// transfer full
GstCaps* StreamConfigToCaps(const rtp::StreamConfig& config);

}  // namespace lidar::gst
