// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/ros2/message_reader.h"

#include <utility>
#include <vector>

#include "ext/ros2/cloud_compression.h"
#include "gst/common/buffer_map.h"
#include "gst/common/coordinate_frames.h"
#include "gst/common/imu_caps.h"
#include "gst/common/pose_covariance.h"
#include "gst/lidar/cloud_info.h"
#include "gst/lidar/gstlidar.h"
#include "src/cdr/motion_samples.h"

namespace lidar::gst {
namespace {

/// Replaces invalid UTF-8, which is not allowed in caps.
std::string ToText(const std::string& name) {
  const StringPtr valid(g_utf8_make_valid(name.data(), static_cast<gssize>(name.size())));
  return valid.get();
}

/// Returns the layout of points that `caps` require, or nothing if they require none.
std::optional<cdr::PointLayout> WantedPoints(const GstCaps* caps) {
  if (caps == nullptr || gst_caps_is_any(caps) || gst_caps_is_empty(caps)) return std::nullopt;
  const GstStructure* s = gst_caps_get_structure(caps, 0);
  const gchar* text = gst_structure_get_string(s, "fields");
  auto fields = PointFields::Parse(text != nullptr ? text : "");
  if (!fields) return std::nullopt;
  gint step = 0;
  gst_structure_get_int(s, "point-step", &step);
  const auto least = fields->MinimumStep();
  return cdr::PointLayout{*std::move(fields), std::max(least, static_cast<guint>(MAX(step, 0)))};
}

BufferPtr Copied(const std::vector<std::uint8_t>& bytes) {
  return BufferPtr(gst_buffer_new_memdup(bytes.data(), bytes.size()));
}

}  // namespace

MessageReader::Verdict MessageReader::Read(ByteView message) {
  switch (type_) {
    case cdr::RosType::kPointCloud2:
      return ReadCloud(message);
    case cdr::RosType::kLivox:
      return ReadLivox(message);
    case cdr::RosType::kCompressedCloud:
      return ReadCompressed(message);
    case cdr::RosType::kImu:
      return ReadImu(message);
    case cdr::RosType::kOdometry:
      return ReadOdometry(message);
    case cdr::RosType::kTransforms:
      break;
  }
  return ReadTransforms(message);
}

void MessageReader::SetStamp(Time stamp) {
  const auto ns = stamp.time_since_epoch().count();
  if (ns > 0) gst_lidar_buffer_set_capture_time(buffer_.get(), static_cast<GstClockTime>(ns));
}

/// Sets new caps: those of `caps` that downstream accepts. `caps` are all caps that are possible
/// for the message.
MessageReader::Verdict MessageReader::SetCaps(CapsPtr caps) {
  const CapsPtr wanted = wanted_();
  if (wanted)
    caps.reset(gst_caps_intersect_full(caps.get(), wanted.get(), GST_CAPS_INTERSECT_FIRST));
  caps.reset(gst_caps_fixate(caps.release()));
  if (gst_caps_is_empty(caps.get())) {
    why_ = "the next element does not accept these caps";
    return Verdict::kNotNegotiated;
  }
  if (!caps_ || !gst_caps_is_equal(caps.get(), caps_.get())) {
    caps_.reset(gst_caps_ref(caps.get()));
    new_caps_ = std::move(caps);
  }
  return Verdict::kBuffer;
}

/// Makes a converter and caps for clouds with a new layout.
MessageReader::Verdict MessageReader::Adapt(const cdr::PointCloud2& cloud) {
  converter_.reset();
  const CapsPtr wanted = wanted_();
  auto converter = cdr::PointConverter::Make(cloud.layout, WantedPoints(wanted.get()), &why_);
  if (!converter) return Verdict::kDamaged;
  CloudInfo info;
  info.width = cloud.layout.width;
  info.height = cloud.layout.height;
  info.point_step = converter->points().point_step;
  info.fields = converter->points().fields;
  info.is_dense = cloud.is_dense;
  CapsPtr caps(info.ToCaps());
  // Messages have no frame rate. A filter downstream may set it.
  gst_structure_remove_field(gst_caps_get_structure(caps.get(), 0), "framerate");
  gst_caps_set_simple(caps.get(), GST_LIDAR_FRAME_ID, G_TYPE_STRING,
                      ToText(cloud.header.frame_id).c_str(), nullptr);
  const Verdict verdict = SetCaps(std::move(caps));
  if (verdict != Verdict::kBuffer) return verdict;
  converter_ = std::move(converter);
  is_dense_ = cloud.is_dense;
  frame_id_ = cloud.header.frame_id;
  return verdict;
}

MessageReader::Verdict MessageReader::ReadCloud(ByteView message) {
  const auto cloud = cdr::ReadPointCloud2(message, &why_);
  return cloud ? ToBuffer(*cloud) : Verdict::kDamaged;
}

MessageReader::Verdict MessageReader::ReadLivox(ByteView message) {
  const auto made = cdr::ReadLivox(message, &why_);
  return made ? ToBuffer(made->cloud) : Verdict::kDamaged;
}

MessageReader::Verdict MessageReader::ReadCompressed(ByteView message) {
  const auto compressed = cdr::ReadCompressedCloud(message, &why_);
  const auto made = compressed ? Decompress(*compressed, &why_) : std::nullopt;
  return made ? ToBuffer(made->cloud) : Verdict::kDamaged;
}

MessageReader::Verdict MessageReader::ToBuffer(const cdr::PointCloud2& cloud) {
  if (cloud.layout.width == 0 || cloud.layout.height == 0) return Verdict::kEmpty;
  const bool same = converter_ && converter_->layout() == cloud.layout &&
                    is_dense_ == cloud.is_dense && frame_id_ == cloud.header.frame_id;
  if (!cdr::RowStride(cloud)) {
    why_ = "the length of its data does not match width, height and steps";
    return Verdict::kDamaged;
  }
  if (!same) {
    const Verdict verdict = Adapt(cloud);
    if (verdict != Verdict::kBuffer) return verdict;
  }
  buffer_.reset(gst_buffer_new_allocate(nullptr, converter_->size(), nullptr));
  {
    BufferMap map(buffer_.get(), GST_MAP_WRITE);
    if (!map || !converter_->Convert(cloud, map.data())) return Verdict::kDamaged;
  }
  SetStamp(cloud.header.stamp);
  return Verdict::kBuffer;
}

MessageReader::Verdict MessageReader::ReadImu(ByteView message) {
  const auto imu = cdr::ReadImu(message);
  if (!imu) {
    why_ = "the message is truncated or is not an Imu";
    return Verdict::kDamaged;
  }
  CapsPtr caps = ImuCaps();
  gst_caps_set_simple(caps.get(), GST_LIDAR_FRAME_ID, G_TYPE_STRING,
                      ToText(imu->header.frame_id).c_str(), nullptr);
  buffer_ = Copied(cdr::WriteImuSample(*imu));
  SetStamp(imu->header.stamp);
  return SetCaps(std::move(caps));
}

MessageReader::Verdict MessageReader::ReadOdometry(ByteView message) {
  const auto odometry = cdr::ReadOdometry(message);
  if (!odometry) {
    why_ = "the message is truncated or is not an Odometry";
    return Verdict::kDamaged;
  }
  CapsPtr caps(gst_caps_new_simple(GST_LIDAR_ODOMETRY_MEDIA_TYPE, GST_LIDAR_FRAME_ID, G_TYPE_STRING,
                                   ToText(odometry->header.frame_id).c_str(),
                                   GST_LIDAR_CHILD_FRAME_ID, G_TYPE_STRING,
                                   ToText(odometry->child_frame_id).c_str(), nullptr));
  buffer_ = Copied(cdr::WritePose(*odometry, TrackingOf(odometry->pose_covariance)));
  SetStamp(odometry->header.stamp);
  return SetCaps(std::move(caps));
}

/// Copies the message without changes, because each of its transforms has its own frames and time.
MessageReader::Verdict MessageReader::ReadTransforms(ByteView message) {
  const auto transforms = cdr::ReadTransforms(message);
  if (!transforms) {
    why_ = "the message is truncated or is not a TFMessage";
    return Verdict::kDamaged;
  }
  if (transforms->empty()) return Verdict::kEmpty;
  CapsPtr caps(gst_caps_new_simple(GST_LIDAR_TF_MEDIA_TYPE, GST_LIDAR_TF_STATIC, G_TYPE_BOOLEAN,
                                   for_good_, nullptr));
  buffer_.reset(gst_buffer_new_memdup(message.data, message.size));
  SetStamp(transforms->front().header.stamp);
  return SetCaps(std::move(caps));
}

}  // namespace lidar::gst
