// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/ouster/slice_buffer.h"

#include <utility>
#include <vector>

#include "gst/lidar/cloud_info.h"
#include "gst/lidar/gstlidar.h"

namespace lidar::gst {
GstClockTime ToClockTime(Time time) {
  const auto ns = time.time_since_epoch().count();
  return ns > 0 ? static_cast<GstClockTime>(ns) : 0;
}

GstCaps* CapsOf(const ouster::SensorStream& stream) {
  constexpr gint kMaxDenominator = 1000;
  const ouster::Metadata& metadata = stream.metadata();
  CloudInfo info;
  info.width = stream.batcher().slice_width();
  info.height = metadata.format.beams;
  info.point_step = stream.writer().point_step();
  info.fields = stream.writer().fields();
  info.is_dense = false;
  gst_util_double_to_fraction(metadata.scans_per_second, &info.framerate_n, &info.framerate_d);
  if (info.framerate_d > kMaxDenominator) {
    info.framerate_n = static_cast<gint>(metadata.scans_per_second * kMaxDenominator + 0.5);
    info.framerate_d = kMaxDenominator;
  }
  // A sensor model has one direction for each beam, and columns in the order of measurement ids. It
  // cannot describe a sensor with a direction for each pixel, nor beams that were destaggered.
  if (metadata.pixel_angles.empty() && !stream.options().points.destagger)
    info.sensor_model = metadata.model;
  return info.ToCaps();
}

GstBuffer* ToBuffer(ouster::TimedSlice timed, Duration duration) {
  using Points = std::vector<std::uint8_t>;
  ouster::Slice& slice = timed.slice;
  auto* points = new Points(std::move(slice.points));
  GstBuffer* buffer = gst_buffer_new_wrapped_full(
      static_cast<GstMemoryFlags>(0), points->data(), points->size(), 0, points->size(), points,
      [](gpointer p) { delete static_cast<Points*>(p); });
  GST_BUFFER_PTS(buffer) = ToClockTime(timed.local);
  GST_BUFFER_DURATION(buffer) = static_cast<GstClockTime>(duration.count());
  if (slice.after_gap) GST_BUFFER_FLAG_SET(buffer, GST_BUFFER_FLAG_DISCONT);
  const GstLidarSlice meta{slice.scan_id, slice.index, slice.count, slice.first_column};
  gst_lidar_buffer_set_slice(buffer, &meta);
  gst_lidar_buffer_set_capture_time(buffer, ToClockTime(timed.utc));
  return buffer;
}

}  // namespace lidar::gst
