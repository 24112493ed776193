// SPDX-License-Identifier: LGPL-2.1-or-later
// The bitrate properties of encoders and their units, by the encoder's factory.
#pragma once
#include <gst/gst.h>

#include <optional>
#include <string>

#include "gst/common/refs.h"

namespace lidar::gst {

struct BitrateControl {
  std::string property;
  gdouble bps_per_unit = 1;  // 1000 if the property is in kbit/s
  std::string control;       // field of a GstStructure property, such as V4L2's extra-controls
};

/// Returns the bitrate control of encoders that `factory` makes, or nothing for an unknown factory.
std::optional<BitrateControl> FindBitrateControl(const std::string& factory);

/// Returns the first element upstream of `pad` whose klass contains "Encoder", or null if there is
/// none. The search passes only through elements and bins that have a single input.
ElementPtr FindEncoderUpstream(GstPad* pad);

/// Sets the property or field that `control` names to `bps`, limited to the range of the property.
/// Returns the bitrate that was set [bit/s], or nothing if the encoder has no such numeric
/// property.
std::optional<guint> SetEncoderBitrate(GstElement* encoder, const BitrateControl& control,
                                       guint bps);

}  // namespace lidar::gst
