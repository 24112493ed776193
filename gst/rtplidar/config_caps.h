// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts caps of encoded clouds to stream configs and back.
#pragma once
#include <gst/gst.h>

#include <optional>
#include <string>

#include "src/rtp/stream_config.h"

namespace lidar::gst {

/// Returns nothing if a receiver would refuse the config: `why` then has the reason in words for a
/// user.
std::optional<rtp::StreamConfig> StreamConfigFromCaps(const GstCaps* caps, std::string* why);
/// transfer full
GstCaps* StreamConfigToCaps(const rtp::StreamConfig& config);

}  // namespace lidar::gst
