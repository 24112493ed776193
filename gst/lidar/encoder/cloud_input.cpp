// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/lidar/encoder/cloud_input.h"

#include <utility>

namespace lidar::gst {

void CloudInput::SetFormat(const CloudInfo& info, bool codes_ranges) {
  info_ = info;
  range_check_.reset();
  if (codes_ranges && info.sensor_model)
    range_check_ = RangeCheck::Create(info.fields, info.point_step, *info.sensor_model);
}

CloudInput::Place CloudInput::PlaceOf(GstBuffer* buffer) {
  Place place;
  GstLidarSlice& slice = place.slice;
  if (!gst_lidar_buffer_get_slice(buffer, &slice)) slice.scan_id = scans_without_meta_++;
  place.in_stream = {slice.scan_id, slice.slice_index, slice.slice_count, 10};
  if (info_.framerate_n > 0)
    place.in_stream.scans_per_second = static_cast<double>(info_.framerate_n) / info_.framerate_d;
  place.starts_scan = std::exchange(scan_id_, slice.scan_id) != slice.scan_id;
  return place;
}

std::optional<GstLidarRawSlice> CloudInput::Read(GstLidarEncoder* encoder, const BufferMap& map,
                                                 const GstLidarSlice& slice) {
  if (!map) {
    GST_ELEMENT_ERROR(encoder, RESOURCE, READ, (nullptr), ("cannot map a buffer"));
    return std::nullopt;
  }
  const gsize row = gsize{info_.point_step} * info_.height;
  if (map.size() % row != 0 || (info_.width > 0 && map.size() != info_.FrameSize())) {
    GST_ELEMENT_ERROR(
        encoder, STREAM, ENCODE, ("A buffer does not match its caps."),
        ("it has %" G_GSIZE_FORMAT " bytes, but the caps describe %u x %u points of %u bytes",
         map.size(), info_.width, info_.height, info_.point_step));
    return std::nullopt;
  }
  CheckRanges(encoder, map.view(), slice.first_column);
  return GstLidarRawSlice{
      map.data(),        map.size(),         static_cast<guint>(map.size() / row),
      info_.height,      slice.first_column, slice.scan_id,
      slice.slice_index, slice.slice_count};
}

void CloudInput::CheckRanges(GstLidarEncoder* encoder, ByteView raw, guint first_column) {
  if (!range_check_ || warned_of_ranges_) return;
  const auto found = range_check_->Find(raw, first_column);
  if (!found) return;
  warned_of_ranges_ = true;
  GST_ELEMENT_WARNING(encoder, STREAM, ENCODE,
                      ("The points of this cloud do not match its ranges and its sensor-model, but "
                       "only ranges are sent. Set geometry=xyz."),
                      ("the point of beam %u, column %u is %f m away", found->beam, found->column,
                       found->distance_m));
}

void CloudInput::WarnOfReach(GstLidarEncoder* encoder, double extent_m) {
  if (std::exchange(warned_of_reach_, true)) return;
  GST_ELEMENT_WARNING(
      encoder, STREAM, ENCODE,
      ("A cloud is too large for max-error and was left out. Raise max-error, or crop the cloud."),
      ("the longest side of its box is %f m", extent_m));
}

}  // namespace lidar::gst
