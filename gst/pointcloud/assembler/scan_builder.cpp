// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/pointcloud/assembler/scan_builder.h"

#include <cstring>

#include "gst/common/buffer_map.h"

namespace lidar::gst {
namespace {

constexpr guint kMaxSlices = 4096;
constexpr gsize kMaxScanSize = gsize{1} << 29;

/// Returns the number of columns of a full turn. Without a sensor model, all slices of a scan
/// together count as one turn.
guint ColumnsPerTurn(const CloudInfo& info, guint slices) {
  return info.sensor_model ? info.sensor_model->columns_per_scan : info.width * slices;
}

GstClockTime Back(GstClockTime time, GstClockTime by) { return time > by ? time - by : 0; }

}  // namespace

bool ScanBuilder::IsSane(const SliceView& slice) {
  const GstLidarSlice& meta = slice.meta;
  if (meta.slice_count == 0 || meta.slice_count > kMaxSlices ||
      meta.slice_index >= meta.slice_count ||
      gst_buffer_get_size(slice.buffer) != slice.info->FrameSize()) {
    return false;
  }
  if (!IsOrganised(*slice.info)) return slice.info->FrameSize() * meta.slice_count <= kMaxScanSize;
  const guint64 columns = guint64{slice.info->width} * meta.slice_count;
  // An azimuth window is padded to a multiple of the slice width, so it may exceed a full turn by
  // less than the width of a slice.
  const guint64 most = slice.info->sensor_model
                           ? guint64{slice.info->sensor_model->columns_per_scan} + slice.info->width
                           : SensorModel::kMaxColumns;
  return columns <= most && slice.info->FrameSize() * meta.slice_count <= kMaxScanSize;
}

ScanBuilder::ScanBuilder(const SliceView& slice)
    : scan_id_(slice.meta.scan_id),
      info_(*slice.info),
      is_discont_(GST_BUFFER_IS_DISCONT(slice.buffer)),
      present_(slice.meta.slice_count, false) {
  const guint turn = std::max(1U, ColumnsPerTurn(info_, slice.meta.slice_count));
  const guint before = slice.meta.slice_index * info_.width % turn;
  first_column_ = (slice.meta.first_column % turn + turn - before) % turn;
  if (IsOrganised(info_)) {
    scan_.reset(
        gst_buffer_new_allocate(nullptr, info_.FrameSize() * slice.meta.slice_count, nullptr));
  } else {
    parts_.resize(slice.meta.slice_count);
  }
}

bool ScanBuilder::Fits(const SliceView& slice) const {
  return slice.meta.scan_id == scan_id_ && slice.meta.slice_count == present_.size();
}

bool ScanBuilder::Add(const SliceView& slice) {
  const guint index = slice.meta.slice_index;
  if (present_[index]) return false;
  if (!scan_) {
    parts_[index].reset(gst_buffer_ref(slice.buffer));
  } else if (!CopyColumns(slice)) {
    return false;
  }
  present_[index] = true;
  ++present_count_;
  TakeTimes(slice);
  return true;
}

void ScanBuilder::TakeTimes(const SliceView& slice) {
  const std::size_t slices = present_.size();
  const GstClockTime scan = info_.ScanDuration();
  GstClockTime sweep = GST_BUFFER_DURATION(slice.buffer);
  if (!GST_CLOCK_TIME_IS_VALID(sweep)) sweep = GST_CLOCK_TIME_IS_VALID(scan) ? scan / slices : 0;
  const GstClockTime before = sweep * slice.meta.slice_index;
  // The time of the first slice is exact. Until the first slice arrives, the time of the scan is
  // extrapolated back from another slice.
  const auto take = [&](GstClockTime time, GstClockTime* of_scan) {
    if (!GST_CLOCK_TIME_IS_VALID(time)) return;
    if (slice.meta.slice_index == 0 || !GST_CLOCK_TIME_IS_VALID(*of_scan))
      *of_scan = Back(time, before);
  };
  take(GST_BUFFER_PTS(slice.buffer), &pts_);
  take(gst_lidar_buffer_get_capture_time(slice.buffer), &capture_);
  duration_ = sweep > 0 ? sweep * slices : scan;
}

bool ScanBuilder::CopyColumns(const SliceView& slice) {
  const BufferMap in(slice.buffer, GST_MAP_READ);
  BufferMap out(scan_.get(), GST_MAP_WRITE);
  if (!in || !out) return false;
  const gsize row = gsize{info_.width} * info_.point_step;
  const gsize stride = row * present_.size();
  guint8* to = out.data() + row * slice.meta.slice_index;
  const guint8* from = in.data();
  for (guint beam = 0; beam < info_.height; ++beam, from += row, to += stride)
    std::memcpy(to, from, row);
  return true;
}

void ScanBuilder::ZeroColumns(guint index) {
  BufferMap out(scan_.get(), GST_MAP_WRITE);
  if (!out) return;
  const gsize row = gsize{info_.width} * info_.point_step;
  guint8* to = out.data() + row * index;
  for (guint beam = 0; beam < info_.height; ++beam, to += row * present_.size())
    std::memset(to, 0, row);
}

BufferPtr ScanBuilder::Concatenate(guint* points) const {
  gsize size = 0;
  for (const BufferPtr& part : parts_) size += part ? gst_buffer_get_size(part.get()) : 0;
  BufferPtr scan(gst_buffer_new_allocate(nullptr, size, nullptr));
  gsize offset = 0;
  for (const BufferPtr& part : parts_) {
    if (!part) continue;
    const BufferMap map(part.get(), GST_MAP_READ);
    offset += gst_buffer_fill(scan.get(), offset, map.data(), map.size());
  }
  *points = static_cast<guint>(size / info_.point_step);
  return scan;
}

FinishedScan ScanBuilder::Finish() {
  FinishedScan out;
  out.complete = complete();
  if (scan_) {
    for (guint i = 0; i < present_.size(); ++i)
      if (!present_[i]) ZeroColumns(i);
    out.width = info_.width * static_cast<guint>(present_.size());
    out.buffer = std::move(scan_);
  } else {
    out.buffer = Concatenate(&out.width);
  }
  GstBuffer* buffer = out.buffer.get();
  GST_BUFFER_PTS(buffer) = pts_;
  GST_BUFFER_DURATION(buffer) = duration_;
  const GstLidarSlice whole{scan_id_, 0, 1, first_column_};
  gst_lidar_buffer_set_slice(buffer, &whole);
  if (GST_CLOCK_TIME_IS_VALID(capture_)) gst_lidar_buffer_set_capture_time(buffer, capture_);
  if (!out.complete) GST_BUFFER_FLAG_SET(buffer, GST_BUFFER_FLAG_CORRUPTED);
  if (is_discont_) GST_BUFFER_FLAG_SET(buffer, GST_BUFFER_FLAG_DISCONT);
  return out;
}

}  // namespace lidar::gst
