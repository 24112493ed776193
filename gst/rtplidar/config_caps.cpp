// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/rtplidar/config_caps.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <utility>

#include "gst/common/buffer_map.h"
#include "gst/common/caps_text.h"
#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"

namespace lidar::gst {
namespace {

struct CoderName {
  rtp::Coder coder;
  const gchar* media_type;
};
constexpr CoderName kCoders[] = {{rtp::Coder::kDraco, GST_LIDAR_DRACO_MEDIA_TYPE},
                                 {rtp::Coder::kLidar, GST_LIDAR_SLICE_MEDIA_TYPE}};

constexpr gsize kMaxModelSize = 0xFFFF;  // its length field has 16 bits

bool ReadModel(const GstStructure* s, rtp::StreamConfig* config) {
  const GValue* value = gst_structure_get_value(s, "sensor-model");
  if (value == nullptr) return true;
  GstBuffer* buffer = GST_VALUE_HOLDS_BUFFER(value) ? gst_value_get_buffer(value) : nullptr;
  if (buffer == nullptr) return false;
  const BufferMap map(buffer, GST_MAP_READ);
  if (!map || map.size() > kMaxModelSize) return false;
  config->sensor_model.assign(map.view().begin(), map.view().end());
  return true;
}

/// Returns nothing if a field is missing or too long for the wire format.
std::optional<rtp::StreamConfig> NumberedConfig(rtp::Coder coder, const GstStructure* s) {
  const gchar* fields = gst_structure_get_string(s, "fields");
  const gchar* geometry = gst_structure_get_string(s, "geometry");
  rtp::StreamConfig config;
  config.coder = coder;
  if (fields == nullptr || std::strlen(fields) > 0xFFFF || !ReadModel(s, &config))
    return std::nullopt;
  config.fields = fields;
  config.geometry = g_strcmp0(geometry, "range") == 0 ? Geometry::kRange : Geometry::kXyz;
  gint n = 0;
  gint d = 1;
  if (gst_structure_get_fraction(s, "framerate", &n, &d) && n >= 0 && d > 0) {
    config.framerate_n = static_cast<std::uint32_t>(n);
    config.framerate_d = static_cast<std::uint32_t>(d);
  }
  return config;
}

std::optional<rtp::StreamConfig> NamedConfig(const GstCaps* caps, std::string* why) {
  auto scalar = ToScalarCaps(caps, why);
  if (!scalar) return std::nullopt;
  rtp::StreamConfig config;
  config.coder = rtp::Coder::kNamed;
  config.caps = *std::move(scalar);
  *why = "only slices can be sent, and their caps have alignment=slice";
  return config;
}

}  // namespace

std::optional<rtp::StreamConfig> StreamConfigFromCaps(const GstCaps* caps, std::string* why) {
  const GstStructure* s = gst_caps_get_structure(caps, 0);
  const auto* known = std::find_if(std::begin(kCoders), std::end(kCoders), [&](const auto& name) {
    return gst_structure_has_name(s, name.media_type);
  });
  const bool numbered = known != std::end(kCoders);
  *why = "they need packed fields with x, y and z as F32, and with geometry=range a sensor-model";
  const auto config = numbered ? NumberedConfig(known->coder, s) : NamedConfig(caps, why);
  if (!config) return std::nullopt;
  // Checks that a receiver can parse the config.
  const auto bytes = config->Serialise();
  return rtp::StreamConfig::Parse({bytes.data(), bytes.size()});
}

GstCaps* StreamConfigToCaps(const rtp::StreamConfig& config) {
  if (config.coder == rtp::Coder::kNamed) return FromScalarCaps(config.caps).release();
  const bool range = config.geometry == Geometry::kRange;
  const gchar* media_type = GST_LIDAR_DRACO_MEDIA_TYPE;
  for (const CoderName& name : kCoders)
    if (name.coder == config.coder) media_type = name.media_type;
  GstCaps* caps = gst_caps_new_simple(
      media_type, "geometry", G_TYPE_STRING, range ? "range" : "xyz", "alignment", G_TYPE_STRING,
      "slice", "fields", G_TYPE_STRING, config.fields.c_str(), "framerate", GST_TYPE_FRACTION,
      static_cast<gint>(config.framerate_n), static_cast<gint>(config.framerate_d), nullptr);
  if (!config.sensor_model.empty()) {
    const BufferPtr model(
        gst_buffer_new_memdup(config.sensor_model.data(), config.sensor_model.size()));
    gst_caps_set_simple(caps, "sensor-model", GST_TYPE_BUFFER, model.get(), nullptr);
  }
  return caps;
}

}  // namespace lidar::gst
