// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/mcap/buffer_writer.h"

#include <algorithm>
#include <utility>

#include "gst/common/buffer_map.h"
#include "gst/common/coordinate_frames.h"
#include "gst/common/pose_covariance.h"
#include "gst/lidar/cloud_info.h"
#include "gst/lidar/gstlidar.h"
#include "src/cdr/coded_slice.h"
#include "src/cdr/motion_samples.h"
#include "src/cdr/point_cloud2.h"

namespace lidar::gst {
namespace {

/// Returns a ROS header. Its stamp is 0 if the time is unknown.
cdr::Header HeaderOf(GstClockTime time, const std::string& frame_id) {
  const GstClockTime known = GST_CLOCK_TIME_IS_VALID(time) ? time : 0;
  return {Time(Duration(static_cast<gint64>(std::min<GstClockTime>(known, G_MAXINT64)))), frame_id};
}

GstClockTime CaptureTime(GstBuffer* buffer, GstClockTime otherwise) {
  const GstClockTime time = gst_lidar_buffer_get_capture_time(buffer);
  return GST_CLOCK_TIME_IS_VALID(time) ? time : otherwise;
}

/// Returns `wanted` unless it is empty. Otherwise returns the frame in `field` of the caps, or
/// `usual` if the caps have no frame.
std::string FrameOf(const GstCaps* caps, const std::string& wanted, const char* field,
                    const char* usual) {
  if (!wanted.empty()) return wanted;
  const std::string frame = FrameIn(gst_caps_get_structure(caps, 0), field);
  return frame.empty() ? usual : frame;
}

class SliceWriter : public BufferWriter {
 public:
  explicit SliceWriter(const std::string& frame_id) : BufferWriter(MessageType::kSlice, frame_id) {}

  bool Write(GstBuffer* buffer, GstClockTime log_time, std::vector<NewMessage>* out) override {
    const BufferMap map(buffer, GST_MAP_READ);
    if (!map) return false;
    cdr::CodedSlice slice;
    slice.header = HeaderOf(gst_lidar_buffer_get_capture_time(buffer), frame_id_);
    if (GST_BUFFER_DURATION_IS_VALID(buffer))
      slice.duration = Duration(static_cast<gint64>(GST_BUFFER_DURATION(buffer)));
    GstLidarSlice place{};
    if (gst_lidar_buffer_get_slice(buffer, &place)) {
      slice.scan_id = place.scan_id;
      slice.slice_index = place.slice_index;
      slice.slice_count = place.slice_count;
      slice.first_column = place.first_column;
    }
    slice.discontinuity = GST_BUFFER_FLAG_IS_SET(buffer, GST_BUFFER_FLAG_DISCONT);
    slice.data = map.view();
    out->push_back({0, CaptureTime(buffer, log_time), cdr::WriteCodedSlice(slice)});
    return true;
  }
};

class CloudWriter : public BufferWriter {
 public:
  CloudWriter(CloudInfo info, const std::string& frame_id)
      : BufferWriter(MessageType::kCloud, frame_id), info_(std::move(info)) {}

  bool Write(GstBuffer* buffer, GstClockTime log_time, std::vector<NewMessage>* out) override {
    const BufferMap map(buffer, GST_MAP_READ);
    if (!map || map.size() != info_.FrameSize()) return false;
    const GstClockTime stamp = CaptureTime(buffer, log_time);
    cdr::PointCloud2 cloud;
    cloud.header = HeaderOf(stamp, frame_id_);
    cloud.layout = cdr::ToRosLayout({info_.fields, info_.point_step}, info_.width, info_.height);
    cloud.data = map.view();
    cloud.is_dense = info_.is_dense;
    out->push_back({0, stamp, cdr::WritePointCloud2(cloud)});
    return true;
  }

 private:
  const CloudInfo info_;
};

/// Writes one message for each sample of a packet.
class ImuWriter : public BufferWriter {
  /// If a sample is earlier than the first sample of its packet, or later by more than this, the
  /// sensor's clock was set. Such a sample gets the log time of the sample before it.
  static constexpr std::uint64_t kLongestPacket = GST_SECOND;

 public:
  explicit ImuWriter(const std::string& frame_id) : BufferWriter(MessageType::kImu, frame_id) {}

  bool Write(GstBuffer* buffer, GstClockTime, std::vector<NewMessage>* out) override {
    const BufferMap map(buffer, GST_MAP_READ);
    if (!map || map.size() % kImuSampleSize != 0) return false;
    std::uint64_t first = 0;
    std::uint64_t after = 0;
    for (cdr::Imu& imu : cdr::ReadImuSamples(map.view())) {
      const auto time = static_cast<std::uint64_t>(imu.header.stamp.time_since_epoch().count());
      if (first == 0) first = time;
      imu.header.frame_id = frame_id_;
      if (time >= first && time - first <= kLongestPacket) after = time - first;
      out->push_back({after, time, cdr::WriteImu(imu)});
    }
    return true;
  }
};

class OdometryWriter : public BufferWriter {
 public:
  OdometryWriter(const std::string& frame_id, std::string child_frame_id)
      : BufferWriter(MessageType::kOdometry, frame_id),
        child_frame_id_(std::move(child_frame_id)) {}

  bool Write(GstBuffer* buffer, GstClockTime log_time, std::vector<NewMessage>* out) override {
    const BufferMap map(buffer, GST_MAP_READ);
    std::uint64_t tracking = 0;
    auto odometry = map ? cdr::ReadPose(map.view(), &tracking) : std::nullopt;
    if (!odometry) return false;
    const GstClockTime stamp = CaptureTime(buffer, log_time);
    odometry->header = HeaderOf(stamp, frame_id_);
    odometry->child_frame_id = child_frame_id_;
    odometry->pose_covariance = CovarianceOf(tracking, odometry->pose_covariance);
    odometry->twist_covariance = NoVelocity();
    out->push_back({0, stamp, cdr::WriteOdometry(*odometry)});
    return true;
  }

 private:
  const std::string child_frame_id_;
};

}  // namespace

std::unique_ptr<BufferWriter> BufferWriter::Make(const GstCaps* caps,
                                                 const std::string& sensor_frame,
                                                 std::string* why) {
  const auto type = TypeOf(caps);
  if (!type) {
    *why =
        std::string("mcapsink records clouds, coded slices, IMU samples and odometry, but not ") +
        gst_structure_get_name(gst_caps_get_structure(caps, 0));
    return nullptr;
  }
  const std::string frame_id = FrameOf(caps, sensor_frame, GST_LIDAR_FRAME_ID,
                                       *type == MessageType::kImu ? kImuFrame : kCloudFrame);
  switch (*type) {
    case MessageType::kImu:
      if (IsOurImu(caps)) return std::make_unique<ImuWriter>(frame_id);
      *why = std::string("the fields of IMU samples must be ") + kImuFields;
      return nullptr;
    case MessageType::kOdometry:
      return std::make_unique<OdometryWriter>(
          FrameOf(caps, "", GST_LIDAR_FRAME_ID, kOdometryFrame),
          FrameOf(caps, sensor_frame, GST_LIDAR_CHILD_FRAME_ID, kCloudFrame));
    case MessageType::kSlice:
      return std::make_unique<SliceWriter>(frame_id);
    case MessageType::kCloud:
      break;
  }
  auto info = CloudInfo::FromFrameCaps(caps, why);
  if (!info) return nullptr;
  return std::make_unique<CloudWriter>(*std::move(info), frame_id);
}

}  // namespace lidar::gst
