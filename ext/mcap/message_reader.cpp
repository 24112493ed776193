// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/mcap/message_reader.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>

#include "gst/common/buffer_map.h"
#include "gst/common/imu_caps.h"
#include "gst/common/pose_covariance.h"
#include "gst/lidar/cloud_info.h"
#include "gst/lidar/gstlidar.h"
#include "src/cdr/coded_slice.h"
#include "src/cdr/motion_samples.h"
#include "src/cdr/point_cloud2.h"

namespace lidar::gst {
namespace {

constexpr guint kMaxSlices = 4'096;
/// The largest cloud. The size of a message does not limit the size of its cloud, because a point
/// of one byte becomes a point of at least twelve bytes.
constexpr gsize kMaxCloud = gsize{256} << 20;  // bytes

void SetCaptureTime(const cdr::Header& header, GstBuffer* buffer) {
  const gint64 ns = header.stamp.time_since_epoch().count();
  if (ns > 0) gst_lidar_buffer_set_capture_time(buffer, static_cast<GstClockTime>(ns));
}

class SliceReader : public MessageReader {
 public:
  explicit SliceReader(CapsPtr caps) { caps_ = std::move(caps); }

  BufferPtr Read(ByteView message) override {
    const auto slice = cdr::ReadCodedSlice(message);
    if (!slice || slice->slice_count > kMaxSlices ||
        (slice->slice_count > 0 && slice->slice_index >= slice->slice_count))
      return nullptr;
    BufferPtr buffer(gst_buffer_new_memdup(slice->data.data, slice->data.size));
    SetCaptureTime(slice->header, buffer.get());
    if (slice->duration)
      GST_BUFFER_DURATION(buffer.get()) = static_cast<GstClockTime>(slice->duration->count());
    if (slice->discontinuity) GST_BUFFER_FLAG_SET(buffer.get(), GST_BUFFER_FLAG_DISCONT);
    if (slice->slice_count > 0) {
      const GstLidarSlice place{slice->scan_id, slice->slice_index, slice->slice_count,
                                slice->first_column};
      gst_lidar_buffer_set_slice(buffer.get(), &place);
    }
    return buffer;
  }
};

class CloudReader : public MessageReader {
 public:
  /// `caps` may be NULL, because ROS messages contain nearly all of the information in the caps.
  explicit CloudReader(CapsPtr caps) {
    if (caps) info_ = CloudInfo::FromFrameCaps(caps.get());
    if (!info_) return;
    recorded_ = cdr::PointLayout{info_->fields, info_->point_step};
    caps_ = std::move(caps);
  }

  BufferPtr Read(ByteView message) override {
    const auto cloud = cdr::ReadPointCloud2(message);
    // Checks the sizes in the message before memory is allocated.
    if (!cloud || cloud->layout.width == 0 || cloud->layout.height == 0 ||
        !cdr::RowStride(*cloud) || !Follow(*cloud))
      return nullptr;
    if (converter_->size() > kMaxCloud) return nullptr;
    BufferPtr buffer(gst_buffer_new_allocate(nullptr, converter_->size(), nullptr));
    BufferMap map(buffer.get(), GST_MAP_WRITE);
    if (!map) return nullptr;
    if (!converter_->copies()) std::memset(map.data(), 0, map.size());  // for gaps of fields
    if (!converter_->Convert(*cloud, map.data())) return nullptr;
    SetCaptureTime(cloud->header, buffer.get());
    GST_BUFFER_DURATION(buffer.get()) = info_->ScanDuration();
    return buffer;
  }

 private:
  /// Updates the converter and the caps if the layout of the message differs from the last layout.
  /// Returns false if the layout cannot be converted.
  bool Follow(const cdr::PointCloud2& cloud) {
    if (converter_ && converter_->layout() == cloud.layout && info_->is_dense == cloud.is_dense)
      return true;
    converter_ = cdr::PointConverter::Make(cloud.layout, recorded_);
    if (!converter_ && recorded_) converter_ = cdr::PointConverter::Make(cloud.layout);
    if (!converter_) return false;
    CloudInfo info = info_.value_or(CloudInfo());
    info.width = cloud.layout.width;
    info.height = cloud.layout.height;
    info.point_step = converter_->points().point_step;
    info.fields = converter_->points().fields;
    info.is_dense = cloud.is_dense;
    if (info.sensor_model && info.sensor_model->beams.size() != info.height)
      info.sensor_model.reset();
    info_ = std::move(info);
    CapsPtr caps = CapsOfLayout();
    if (!caps_ || !gst_caps_is_equal(caps.get(), caps_.get())) caps_ = std::move(caps);
    return true;
  }
  /// Returns the recorded caps with the layout of the message.
  CapsPtr CapsOfLayout() const {
    CapsPtr caps(caps_ ? gst_caps_copy(caps_.get()) : info_->ToCaps());
    gst_caps_set_simple(caps.get(), "width", G_TYPE_INT, static_cast<gint>(info_->width), "height",
                        G_TYPE_INT, static_cast<gint>(info_->height), "point-step", G_TYPE_INT,
                        static_cast<gint>(info_->point_step), "fields", G_TYPE_STRING,
                        info_->fields.ToString().c_str(), "is-dense", G_TYPE_BOOLEAN,
                        gboolean{info_->is_dense}, nullptr);
    if (!info_->sensor_model)
      gst_structure_remove_field(gst_caps_get_structure(caps.get(), 0), "sensor-model");
    return caps;
  }

  std::optional<CloudInfo> info_;
  /// The layout of the points in our own recordings. It lets Read() restore the points exactly,
  /// with the gaps between their fields. Recordings of others have no such layout.
  std::optional<cdr::PointLayout> recorded_;
  std::optional<cdr::PointConverter> converter_;
};

class ImuReader : public MessageReader {
 public:
  explicit ImuReader(CapsPtr caps) {
    if (caps && IsOurImu(caps.get()))
      caps_ = std::move(caps);
    else
      caps_ = ImuCaps();
  }

  BufferPtr Read(ByteView message) override {
    const auto imu = cdr::ReadImu(message);
    if (!imu) return nullptr;
    const mcap::Bytes bytes = cdr::WriteImuSample(*imu);
    BufferPtr buffer(gst_buffer_new_memdup(bytes.data(), bytes.size()));
    SetCaptureTime(imu->header, buffer.get());
    return buffer;
  }
};

class OdometryReader : public MessageReader {
 public:
  /// `caps` may be NULL.
  explicit OdometryReader(CapsPtr caps) {
    caps_ =
        caps ? std::move(caps) : CapsPtr(gst_caps_new_empty_simple(GST_LIDAR_ODOMETRY_MEDIA_TYPE));
  }

  BufferPtr Read(ByteView message) override {
    const auto odometry = cdr::ReadOdometry(message);
    if (!odometry) return nullptr;
    const mcap::Bytes bytes = cdr::WritePose(*odometry, TrackingOf(odometry->pose_covariance));
    BufferPtr buffer(gst_buffer_new_memdup(bytes.data(), bytes.size()));
    SetCaptureTime(odometry->header, buffer.get());
    return buffer;
  }
};

}  // namespace

std::unique_ptr<MessageReader> MessageReader::Make(const mcap::Schema& schema,
                                                   const mcap::Channel& channel) {
  const auto type = TypeOf(schema, channel);
  if (!type) return nullptr;
  const auto text = channel.metadata.find(mcap::kCapsKey);
  CapsPtr caps = text == channel.metadata.end() ? nullptr : CapsOfType(text->second, *type);
  switch (*type) {
    case MessageType::kCloud:
      return std::make_unique<CloudReader>(std::move(caps));
    case MessageType::kImu:
      return std::make_unique<ImuReader>(std::move(caps));
    case MessageType::kOdometry:
      return std::make_unique<OdometryReader>(std::move(caps));
    case MessageType::kSlice:
      break;
  }
  // Slices without caps cannot be decoded.
  return caps ? std::make_unique<SliceReader>(std::move(caps)) : nullptr;
}

}  // namespace lidar::gst
