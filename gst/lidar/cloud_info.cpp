// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/lidar/cloud_info.h"

#include <utility>

#include "gst/common/buffer_map.h"
#include "gst/common/refs.h"

namespace lidar::gst {
namespace {

constexpr gint64 kMaxFrameSize = gint64{1} << 30;

/// Parses the caps in several steps. The first step that fails sets the reason.
class Reader {
 public:
  explicit Reader(const GstStructure* s) : s_(s) {}

  std::optional<CloudInfo> Read(std::string* why) {
    if (ReadPoint() && ReadSize() && ReadModel()) return std::move(info_);
    *why = why_;
    return std::nullopt;
  }

 private:
  bool Fail(std::string why) {
    why_ = std::move(why);
    return false;
  }

  /// Reads a number, which is an `int` in caps. Fails if the number is negative.
  bool GetCount(const char* name, guint* value) {
    gint read = 0;
    if (!gst_structure_get_int(s_, name, &read)) return Fail(std::string(name) + " is missing");
    *value = static_cast<guint>(read);
    return read >= 0 || Fail(std::string(name) + " is negative");
  }
  bool Flag(const char* name) const {
    gboolean flag = FALSE;
    return gst_structure_get_boolean(s_, name, &flag) && flag;
  }

  bool ReadPoint() {
    if (!gst_structure_has_name(s_, GST_LIDAR_CLOUD_MEDIA_TYPE))
      return Fail(std::string(gst_structure_get_name(s_)) + " is not " GST_LIDAR_CLOUD_MEDIA_TYPE);
    const gchar* fields = gst_structure_get_string(s_, "fields");
    if (fields == nullptr)
      return Fail("fields is missing, for example fields=x:F32:0,y:F32:4,z:F32:8");
    auto parsed = PointFields::Parse(fields, &why_);
    if (!parsed || !GetCount("point-step", &info_.point_step)) return false;
    if (info_.point_step < parsed->MinimumStep())
      return Fail("the fields end past point-step=" + std::to_string(info_.point_step));
    if (info_.point_step > PointFields::kMaxPointStep)
      return Fail("point-step is above " + std::to_string(PointFields::kMaxPointStep));
    if (Flag("is-bigendian")) return Fail("is-bigendian=true: clouds must be little-endian");
    info_.fields = *std::move(parsed);
    info_.is_dense = Flag("is-dense");
    return true;
  }

  bool ReadSize() {
    if ((gst_structure_has_field(s_, "height") && !GetCount("height", &info_.height)) ||
        (gst_structure_has_field(s_, "width") && !GetCount("width", &info_.width)))
      return false;
    if (info_.height == 0) return Fail("height is 0");
    if (gint64{info_.width} * info_.height > kMaxFrameSize / info_.point_step)
      return Fail("width x height x point-step is above 1 GiB");
    gst_structure_get_fraction(s_, "framerate", &info_.framerate_n, &info_.framerate_d);
    return true;
  }

  bool ReadModel() {
    if (!gst_structure_has_field(s_, "sensor-model")) return true;
    info_.sensor_model = SensorModelFromStructure(s_);
    if (!info_.sensor_model) return Fail("sensor-model is damaged");
    return info_.sensor_model->beams.size() == info_.height ||
           Fail("sensor-model has " + std::to_string(info_.sensor_model->beams.size()) +
                " beams where height=" + std::to_string(info_.height));
  }

  const GstStructure* s_;
  CloudInfo info_;
  std::string why_;
};

}  // namespace

std::optional<CloudInfo> CloudInfo::FromCaps(const GstCaps* caps, std::string* why) {
  std::string ignored;
  std::string& reason = why != nullptr ? *why : ignored;
  reason = "there are no caps";
  if (caps == nullptr || gst_caps_is_empty(caps) || gst_caps_is_any(caps)) return std::nullopt;
  return Reader(gst_caps_get_structure(caps, 0)).Read(&reason);
}

std::optional<CloudInfo> CloudInfo::FromFrameCaps(const GstCaps* caps, std::string* why) {
  auto info = FromCaps(caps, why);
  if (!info || info->width > 0) return info;
  if (why != nullptr) *why = "width is missing; pointcloudparse adds it";
  return std::nullopt;
}

std::optional<CloudInfo> CloudInfo::FromCodedCaps(const GstCaps* caps) {
  const GstStructure* s = gst_caps_get_structure(caps, 0);
  const gchar* fields = gst_structure_get_string(s, "fields");
  CloudInfo cloud;
  auto parsed = PointFields::Parse(fields != nullptr ? fields : "x:F32:0,y:F32:4,z:F32:8");
  if (!parsed || !parsed->HasPackedXyz() || !parsed->ArePacked()) return std::nullopt;
  cloud.fields = *std::move(parsed);
  cloud.point_step = cloud.fields.MinimumStep();
  gst_structure_get_fraction(s, "framerate", &cloud.framerate_n, &cloud.framerate_d);
  cloud.sensor_model = SensorModelFromStructure(s);
  if (cloud.sensor_model) cloud.height = static_cast<guint>(cloud.sensor_model->beams.size());
  return cloud;
}

CloudInfo CloudInfo::FromFormat(const GstLidarCloudFormat& format) {
  CloudInfo info;
  info.width = format.width;
  info.height = format.height;
  info.point_step = format.point_step;
  info.fields = PointFields::Parse(format.fields).value_or(PointFields());
  info.framerate_n = format.framerate_n;
  info.framerate_d = format.framerate_d;
  if (format.sensor_model != nullptr) {
    const BufferMap map(format.sensor_model, GST_MAP_READ);
    if (map) info.sensor_model = SensorModel::Parse(map.view());
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
