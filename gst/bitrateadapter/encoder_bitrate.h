// SPDX-License-Identifier: LGPL-2.1-or-later
// The bitrate property of encoders and its unit, by factory.
#pragma once
#include <gst/gst.h>

#include <optional>
#include <string>

#include "gst/common/refs.h"

namespace lidar::gst {

struct BitrateControl {
  std::string property;
  gdouble bps_per_unit = 1;  // 1000 if the property is in kbit/s
  std::string control;       // the field within a GstStructure property, as V4L2's extra-controls
};

/// The control of encoders made by `factory`; nothing for an unknown one.
std::optional<BitrateControl> FindBitrateControl(const std::string& factory);

/// The first element upstream of `pad` whose klass has "Encoder" in it; null if there is none. The
/// search goes only through elements and bins with one input.
ElementPtr FindEncoderUpstream(GstPad* pad);

/// Sets the property or field that `control` names to `bps`, clamped to the property's range.
/// Returns the bitrate that was set [bit/s], or nothing if the encoder has no such numeric
/// property.
std::optional<guint> SetEncoderBitrate(GstElement* encoder, const BitrateControl& control,
                                       guint bps);

}  // namespace lidar::gst
