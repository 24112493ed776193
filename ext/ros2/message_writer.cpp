// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/ros2/message_writer.h"

#include "gst/common/buffer_map.h"
#include "gst/common/coordinate_frames.h"
#include "gst/common/pose_covariance.h"
#include "gst/lidar/gstlidar.h"
#include "src/cdr/motion_samples.h"

namespace lidar::gst {
namespace {

const char* MediaTypeOf(cdr::RosType type) {
  switch (type) {
    case cdr::RosType::kPointCloud2:
    case cdr::RosType::kCompressedCloud:
      return GST_LIDAR_CLOUD_MEDIA_TYPE;
    case cdr::RosType::kImu:
      return GST_LIDAR_IMU_MEDIA_TYPE;
    default:
      return GST_LIDAR_ODOMETRY_MEDIA_TYPE;
  }
}

ByteView View(const std::vector<std::uint8_t>& bytes) { return {bytes.data(), bytes.size()}; }

}  // namespace

std::optional<cdr::RosType> MessageWriter::UsualType(const GstCaps* caps) {
  const GstStructure* s = gst_caps_get_structure(caps, 0);
  for (const cdr::RosTypeInfo& info : cdr::kRosTypes)
    if (gst_structure_has_name(s, MediaTypeOf(info.type))) return info.type;
  return std::nullopt;
}

std::unique_ptr<MessageWriter> MessageWriter::Make(cdr::RosType type, const GstCaps* caps,
                                                   std::string* why) {
  std::unique_ptr<MessageWriter> writer(new MessageWriter(type));
  if (!writer->TakeCaps(caps, why)) return nullptr;
  return writer;
}

bool MessageWriter::TakeCaps(const GstCaps* caps, std::string* why) {
  const GstStructure* s = gst_caps_get_structure(caps, 0);
  if (!gst_structure_has_name(s, MediaTypeOf(type_))) {
    *why = std::string(cdr::InfoOf(type_).name) + " needs caps of " + MediaTypeOf(type_);
    return false;
  }
  from_caps_ = {FrameIn(s, GST_LIDAR_FRAME_ID), FrameIn(s, GST_LIDAR_CHILD_FRAME_ID)};
  if (type_ == cdr::RosType::kImu) {
    const gchar* fields = gst_structure_get_string(s, "fields");
    *why = std::string("the fields of IMU samples must be ") + kImuFields;
    return fields == nullptr || std::string_view(fields) == kImuFields;
  }
  if (!cdr::IsCloud(type_)) return true;
  auto info = CloudInfo::FromCaps(caps, why);
  if (!info) return false;
  info_ = *std::move(info);
  layout_ = cdr::ToRosLayout({info_.fields, info_.point_step}, info_.width, info_.height);
  return true;
}

bool MessageWriter::Write(GstBuffer* buffer, const MessageSettings& settings, Time now,
                          const Publish& publish) {
  const BufferMap map(buffer, GST_MAP_READ);
  if (!map) return false;
  wanted_ = settings;
  const GstClockTime captured = gst_lidar_buffer_get_capture_time(buffer);
  stamp_ = GST_CLOCK_TIME_IS_VALID(captured)
               ? Time{} + Duration{static_cast<std::int64_t>(captured)}
               : now;
  switch (type_) {
    case cdr::RosType::kPointCloud2:
    case cdr::RosType::kCompressedCloud:
      return WriteCloud(map.view(), publish);
    case cdr::RosType::kImu:
      return WriteImu(map.view(), publish);
    default:
      return WritePose(map.view(), publish);
  }
}

cdr::Header MessageWriter::HeaderOf(Time stamp, const char* usual_frame) const {
  if (!wanted_.frames.frame_id.empty()) return {stamp, wanted_.frames.frame_id};
  return {stamp, from_caps_.frame_id.empty() ? usual_frame : from_caps_.frame_id};
}

std::string MessageWriter::ChildFrame() const {
  if (!wanted_.frames.child_frame_id.empty()) return wanted_.frames.child_frame_id;
  return from_caps_.child_frame_id.empty() ? kCloudFrame : from_caps_.child_frame_id;
}

/// Writes a cloud. A cloud with a single row may have any number of points.
bool MessageWriter::WriteCloud(ByteView points, const Publish& publish) {
  const std::size_t row = points.size / info_.height;
  if (points.size % info_.height != 0 || row % info_.point_step != 0) return false;
  if (info_.height > 1 && info_.width > 0 && points.size != info_.FrameSize()) return false;
  cdr::PointCloud2 cloud;
  cloud.header = HeaderOf(stamp_, kCloudFrame);
  layout_.width = static_cast<std::uint32_t>(row / info_.point_step);
  layout_.row_step = static_cast<std::uint32_t>(row);
  cloud.layout = layout_;
  cloud.data = points;
  cloud.is_dense = info_.is_dense;
  return PublishCloud(cloud, publish);
}

bool MessageWriter::PublishCloud(const cdr::PointCloud2& cloud, const Publish& publish) const {
  if (type_ == cdr::RosType::kPointCloud2) {
    const cdr::PointCloud2Frame frame = cdr::FramePointCloud2(cloud);
    publish({View(frame.head), cloud.data, View(frame.tail)});
    return true;
  }
  std::vector<std::uint8_t> packed;
  const auto compressed = Compress(wanted_.compression, cloud, &packed);
  if (!compressed) return false;
  publish({View(cdr::WriteCompressedCloud(*compressed))});
  return true;
}

bool MessageWriter::WriteImu(ByteView samples, const Publish& publish) {
  std::vector<cdr::Imu> messages = cdr::ReadImuSamples(samples);
  for (cdr::Imu& imu : messages) {
    imu.header = HeaderOf(imu.header.stamp, kImuFrame);
    publish({View(cdr::WriteImu(imu))});
  }
  return !messages.empty();
}

bool MessageWriter::WritePose(ByteView bytes, const Publish& publish) {
  std::uint64_t tracking = 0;
  auto pose = cdr::ReadPose(bytes, &tracking);
  if (!pose) return false;
  pose->header = HeaderOf(stamp_, kOdometryFrame);
  pose->child_frame_id = ChildFrame();
  pose->pose_covariance = CovarianceOf(tracking, pose->pose_covariance);
  pose->twist_covariance = NoVelocity();
  const bool wanted = wanted_.position_variance > 0 || wanted_.orientation_variance > 0;
  if (wanted && tracking <= GST_LIDAR_TRACKING_OK) {
    pose->pose_covariance = {};
    SetVariances(wanted_.position_variance, wanted_.orientation_variance, &pose->pose_covariance);
  }
  if (type_ == cdr::RosType::kOdometry) {
    publish({View(cdr::WriteOdometry(*pose))});
  } else if (tracking < GST_LIDAR_TRACKING_LOST) {
    // A transform has no covariance that could mark a pose as a guess. Guesses are therefore not
    // published.
    const cdr::TransformStamped transform{pose->header, pose->child_frame_id, pose->position,
                                          pose->orientation};
    publish({View(cdr::WriteTransforms({transform}))});
  }
  return true;
}

}  // namespace lidar::gst
