// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/nats/stream_format.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "gst/common/caps_text.h"
#include "gst/lidar/cloud_info.h"
#include "gst/lidar/gstlidar.h"
#include "src/base/crc.h"
#include "src/base/pose_bytes.h"

namespace lidar::nats {
namespace {

constexpr std::size_t kIdSize = 16;

std::string IdOf(const std::string& text) {
  const ByteView bytes{reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
  char id[kIdSize + 1];
  std::snprintf(id, sizeof id, "%016llx", static_cast<unsigned long long>(Crc64(bytes)));
  return id;
}

}  // namespace

StreamFormat::Ptr StreamFormat::FromCaps(GstCaps* caps, std::string* why) {
  auto format = std::make_shared<StreamFormat>();
  const GstStructure* s = gst_caps_get_structure(caps, 0);
  if (gst_structure_has_name(s, GST_LIDAR_CLOUD_MEDIA_TYPE)) {
    const auto info = gst::CloudInfo::FromFrameCaps(caps, why);
    if (!info) return nullptr;
    format->size_ = info->FrameSize();
  } else if (gst_structure_has_name(s, GST_LIDAR_IMU_MEDIA_TYPE)) {
    gint size = 0;
    gst_structure_get_int(s, "sample-size", &size);
    if (size <= 0) {
      *why = "the caps of IMU samples have no sample-size";
      return nullptr;
    }
    format->multiple_ = static_cast<std::size_t>(size);
  } else if (gst_structure_has_name(s, GST_LIDAR_ODOMETRY_MEDIA_TYPE)) {
    format->size_ = kPoseSize;
    format->longer_size_ = kPoseSizeWithCovariance;
  } else if (g_strcmp0(gst_structure_get_string(s, "alignment"), "slice") != 0) {
    *why =
        std::string("natssink publishes clouds, coded slices, IMU samples and odometry, but not ") +
        gst_structure_get_name(s);
    return nullptr;
  }
  auto text = gst::CapsToText(caps, why);
  if (!text) return nullptr;
  format->caps_.reset(gst_caps_ref(caps));
  format->text_ = *std::move(text);
  format->id_ = IdOf(format->text_);
  return format;
}

StreamFormat::Ptr StreamFormat::FromText(const std::string& text) {
  const gst::CapsPtr caps = gst::CapsFromText(text);
  if (!caps) return nullptr;
  std::string why;
  const Ptr read = FromCaps(caps.get(), &why);
  if (!read) return nullptr;
  // Uses the id of the sender's text. The id of `read` may differ, because another version of
  // GStreamer may write the same caps differently.
  auto format = std::make_shared<StreamFormat>();
  format->caps_.reset(gst_caps_ref(caps.get()));
  format->text_ = text;
  format->id_ = IdOf(text);
  format->size_ = read->size_;
  format->longer_size_ = read->longer_size_;
  format->multiple_ = read->multiple_;
  return format;
}

bool StreamFormat::Fits(std::size_t size) const {
  const bool known = size_ == 0 || size == size_ || size == longer_size_;
  return size > 0 && known && size % multiple_ == 0;
}

bool IsFormatId(const std::string& text) {
  const auto is_hex = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  return text.size() == kIdSize && std::all_of(text.begin(), text.end(), is_hex);
}

}  // namespace lidar::nats
