// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/web/slice_caps.h"

#include "gst/lidar/gstlidar.h"

namespace lidar::web {

std::optional<SliceCaps> SliceCaps::Parse(const GstCaps* caps, std::string* why) {
  const GstStructure* s = gst_caps_get_structure(caps, 0);
  auto info = gst_structure_has_name(s, GST_LIDAR_SLICE_MEDIA_TYPE)
                  ? gst::CloudInfo::FromCodedCaps(caps)
                  : std::nullopt;
  if (!info) {
    *why = "their fields lack x, y and z as F32 side by side, or have gaps between them";
    return std::nullopt;
  }
  SliceCaps out;
  out.about.has_ranges = g_strcmp0(gst_structure_get_string(s, "geometry"), "xyz") != 0;
  if (out.about.has_ranges && !info->sensor_model) {
    *why = "geometry=range needs a sensor-model";
    return std::nullopt;
  }
  out.about.fields = info->fields.ToString();
  out.about.framerate_n = info->framerate_n;
  out.about.framerate_d = info->framerate_d;
  if (out.about.has_ranges) out.about.sensor_model = info->sensor_model->Serialise();
  out.info = *std::move(info);
  return out;
}

}  // namespace lidar::web
