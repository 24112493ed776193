// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/common/cloud_info.h"

#include "gst/common/buffer_map.h"
#include "gst/common/refs.h"

namespace lidar::gst {
namespace {

constexpr gint64 kMaxFrameSize = gint64{1} << 30;

/// Caps integers are `int`; negative ones make the caps invalid.
bool GetCount(const GstStructure* s, const char* name, guint* value) {
  gint read = 0;
  if (!gst_structure_get_int(s, name, &read)) return false;
  *value = static_cast<guint>(read);
  return read >= 0;
}

}  // namespace

std::optional<CloudInfo> CloudInfo::FromCaps(const GstCaps* caps) {
  if (caps == nullptr || gst_caps_is_empty(caps) || gst_caps_is_any(caps)) return std::nullopt;
  const GstStructure* s = gst_caps_get_structure(caps, 0);
  const gchar* fields = gst_structure_get_string(s, "fields");
  CloudInfo info;
  gboolean flag = FALSE;
  if (!gst_structure_has_name(s, GST_LIDAR_CLOUD_MEDIA_TYPE) || fields == nullptr ||
      !GetCount(s, "point-step", &info.point_step) ||
      (gst_structure_has_field(s, "height") && !GetCount(s, "height", &info.height)) ||
      (gst_structure_has_field(s, "width") && !GetCount(s, "width", &info.width)) ||
      (gst_structure_get_boolean(s, "is-bigendian", &flag) && flag)) {
    return std::nullopt;
  }
  auto parsed = PointFields::Parse(fields);
  if (!parsed || info.point_step < parsed->MinimumStep() ||
      info.point_step > PointFields::kMaxPointStep || info.height == 0 ||
      gint64{info.width} * info.height > kMaxFrameSize / info.point_step) {
    return std::nullopt;
  }
  info.fields = *std::move(parsed);
  flag = FALSE;
  gst_structure_get_boolean(s, "is-dense", &flag);
  info.is_dense = flag != FALSE;
  gst_structure_get_fraction(s, "framerate", &info.framerate_n, &info.framerate_d);
  if (gst_structure_has_field(s, "sensor-model")) {
    info.sensor_model = SensorModelFromStructure(s);
    if (!info.sensor_model || info.sensor_model->beams.size() != info.height) return std::nullopt;
  }
  return info;
}

GstCaps* CloudInfo::ToCaps() const {
  GstCaps* caps = gst_caps_new_simple(
      GST_LIDAR_CLOUD_MEDIA_TYPE, "height", G_TYPE_INT, static_cast<gint>(height), "point-step",
      G_TYPE_INT, static_cast<gint>(point_step), "fields", G_TYPE_STRING, fields.ToString().c_str(),
      "is-bigendian", G_TYPE_BOOLEAN, FALSE, "is-dense", G_TYPE_BOOLEAN, is_dense, "framerate",
      GST_TYPE_FRACTION, framerate_n, framerate_d, nullptr);
  if (width > 0) gst_caps_set_simple(caps, "width", G_TYPE_INT, static_cast<gint>(width), nullptr);
  if (sensor_model) {
    const BufferPtr model(SensorModelToBuffer(*sensor_model));
    gst_caps_set_simple(caps, "sensor-model", GST_TYPE_BUFFER, model.get(), nullptr);
  }
  return caps;
}

GstBuffer* SensorModelToBuffer(const SensorModel& model) {
  const auto bytes = model.Serialise();
  return gst_buffer_new_memdup(bytes.data(), bytes.size());
}

std::optional<SensorModel> SensorModelFromStructure(const GstStructure* structure) {
  const GValue* value = gst_structure_get_value(structure, "sensor-model");
  if (value == nullptr || !GST_VALUE_HOLDS_BUFFER(value)) return std::nullopt;
  GstBuffer* buffer = gst_value_get_buffer(value);
  if (buffer == nullptr) return std::nullopt;
  const BufferMap map(buffer, GST_MAP_READ);
  if (!map) return std::nullopt;
  return SensorModel::Parse(map.view());
}

}  // namespace lidar::gst
