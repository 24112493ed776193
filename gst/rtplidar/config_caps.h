// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts the caps of encoded clouds to stream configs and back.
#pragma once
#include <gst/gst.h>

#include <optional>
#include <string>

#include "src/rtp/stream_config.h"

namespace lidar::gst {

/// Converts caps to a stream config. If a receiver would refuse the config, returns nothing and
/// sets `why` to a reason for the user.
std::optional<rtp::StreamConfig> StreamConfigFromCaps(const GstCaps* caps, std::string* why);
/// Converts a stream config to caps (transfer full).
GstCaps* StreamConfigToCaps(const rtp::StreamConfig& config);

}  // namespace lidar::gst
