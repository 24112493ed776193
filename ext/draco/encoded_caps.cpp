// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/draco/encoded_caps.h"

#include "gst/common/cloud_info.h"
#include "gst/common/gstlidar.h"
#include "gst/common/refs.h"

namespace lidar::gst {

std::optional<EncodedInfo> EncodedInfo::FromCaps(const GstCaps* caps) {
  if (caps == nullptr || gst_caps_is_empty(caps) || gst_caps_is_any(caps)) return std::nullopt;
  const GstStructure* s = gst_caps_get_structure(caps, 0);
  const gchar* geometry = gst_structure_get_string(s, "geometry");
  const gchar* fields = gst_structure_get_string(s, "fields");
  if (!gst_structure_has_name(s, GST_LIDAR_DRACO_MEDIA_TYPE)) return std::nullopt;
  EncodedInfo info;
  // A plain Draco file needs no more caps than its name.
  info.geometry = g_strcmp0(geometry, "range") == 0 ? Geometry::kRange : Geometry::kXyz;
  if (geometry != nullptr && info.geometry == Geometry::kXyz && g_strcmp0(geometry, "xyz") != 0)
    return std::nullopt;
  auto parsed = PointFields::Parse(fields != nullptr ? fields : "x:F32:0,y:F32:4,z:F32:8");
  if (!parsed || !parsed->HasPackedXyz()) return std::nullopt;
  info.fields = *std::move(parsed);
  gst_structure_get_fraction(s, "framerate", &info.framerate_n, &info.framerate_d);
  info.sensor_model = SensorModelFromStructure(s);
  if (info.geometry == Geometry::kRange && !info.sensor_model) return std::nullopt;
  return info;
}

GstCaps* EncodedInfo::ToCaps() const {
  GstCaps* caps = gst_caps_new_simple(GST_LIDAR_DRACO_MEDIA_TYPE, "geometry", G_TYPE_STRING,
                                      geometry == Geometry::kRange ? "range" : "xyz", "alignment",
                                      G_TYPE_STRING, "slice", "fields", G_TYPE_STRING,
                                      fields.ToString().c_str(), "framerate", GST_TYPE_FRACTION,
                                      framerate_n, framerate_d, nullptr);
  if (sensor_model) {
    const BufferPtr model(SensorModelToBuffer(*sensor_model));
    gst_caps_set_simple(caps, "sensor-model", GST_TYPE_BUFFER, model.get(), nullptr);
  }
  return caps;
}

}  // namespace lidar::gst
