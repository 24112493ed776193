// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/pointcloud/parse/cloud_stamper.h"

#include "gst/lidar/gstlidar.h"

namespace lidar::gst {

void CloudStamper::TakeSegment(GstEvent* event) {
  EventPtr owner(event);
  const GstSegment* given = nullptr;
  gst_event_parse_segment(event, &given);
  times_given_ = given->format == GST_FORMAT_TIME;
  place_.shown = 0;
  segment_ = times_given_ ? std::move(owner) : timeline_.ToTime(event, &place_);
}

CloudTimeline::Grid CloudStamper::Grid() const {
  return {cloud_size_, static_cast<guint64>(rate_.n), static_cast<guint64>(rate_.d)};
}

void CloudStamper::ShowGrid() {
  CloudTimeline::Grid grid = Grid();
  if (times_given_) grid.cloud_bytes = 0;
  timeline_.SetGrid(grid);
}

void CloudStamper::SetRate(const FrameRate& rate) {
  const bool changed = rate.n != rate_.n || rate.d != rate_.d;
  rate_ = rate;
  ShowGrid();
  if (changed && place_.next > 0 && !times_given_) segment_ = timeline_.Continue(place_.next);
}

void CloudStamper::SetCloudSize(gsize bytes) {
  cloud_size_ = bytes;
  ShowGrid();
}

void CloudStamper::Stamp(GstBuffer* cloud) {
  const CloudTimeline::Grid grid = Grid();
  const guint64 number = place_.next++;
  if (!times_given_ || !GST_BUFFER_PTS_IS_VALID(cloud)) {
    GST_BUFFER_PTS(cloud) = grid.TimeOf(number);
    GST_BUFFER_DTS(cloud) = GST_CLOCK_TIME_NONE;
  }
  GST_BUFFER_DURATION(cloud) = grid.TimeOf(number + 1) - grid.TimeOf(number);
  StampCapture(cloud);
  NumberScan(cloud, number);
  GST_BUFFER_OFFSET(cloud) = number;
  GST_BUFFER_OFFSET_END(cloud) = number + 1;
  if (!times_given_) timeline_.NotePosition(GST_BUFFER_PTS(cloud) + GST_BUFFER_DURATION(cloud));
}

void CloudStamper::StampCapture(GstBuffer* cloud) {
  if (GST_CLOCK_TIME_IS_VALID(gst_lidar_buffer_get_capture_time(cloud))) return;
  const auto pts = static_cast<GstClockTimeDiff>(GST_BUFFER_PTS(cloud));
  if (!unix_offset_) unix_offset_ = g_get_real_time() * GstClockTimeDiff{GST_USECOND} - pts;
  const GstClockTimeDiff time = *unix_offset_ + pts;
  if (time >= 0) gst_lidar_buffer_set_capture_time(cloud, static_cast<GstClockTime>(time));
}

void CloudStamper::NumberScan(GstBuffer* cloud, guint64 number) {
  GstLidarSlice slice{};
  if (gst_lidar_buffer_get_slice(cloud, &slice)) return;
  slice = {static_cast<guint>(number), 0, 1, 0};
  gst_lidar_buffer_set_slice(cloud, &slice);
}

void CloudStamper::Flush(bool restarts_time) {
  place_ = {};
  segment_.reset();
  if (restarts_time) timeline_.RestartTime();
}

void CloudStamper::Reset() {
  Flush(true);
  timeline_.Reset();
  times_given_ = false;
  unix_offset_.reset();
  cloud_size_ = 0;
}

}  // namespace lidar::gst
