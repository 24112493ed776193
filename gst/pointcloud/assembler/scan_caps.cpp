// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/pointcloud/assembler/scan_caps.h"

namespace lidar::gst {

CapsPtr ScanCaps(const GstCaps* slice, const CloudInfo& slice_info, guint width) {
  CapsPtr caps(gst_caps_copy(slice));
  gst_caps_set_simple(caps.get(), "width", G_TYPE_INT, static_cast<gint>(width), nullptr);
  // A scan of dense slices is not dense if one of the slices is lost.
  if (ScanBuilder::IsOrganised(slice_info) && width != slice_info.width)
    gst_caps_set_simple(caps.get(), "is-dense", G_TYPE_BOOLEAN, FALSE, nullptr);
  return caps;
}

bool SameButForWidth(const GstCaps* a, const GstCaps* b) {
  const CapsPtr one(gst_caps_copy(a));
  const CapsPtr other(gst_caps_copy(b));
  gst_caps_set_simple(one.get(), "width", G_TYPE_INT, 1, nullptr);
  gst_caps_set_simple(other.get(), "width", G_TYPE_INT, 1, nullptr);
  return gst_caps_is_equal(one.get(), other.get()) != FALSE;
}

bool CannotMix(const CloudInfo& a, const CloudInfo& b) {
  const bool organised = ScanBuilder::IsOrganised(b);
  return a.height != b.height || a.point_step != b.point_step || a.fields != b.fields ||
         ScanBuilder::IsOrganised(a) != organised || (organised && a.width != b.width);
}

GstClockTime DeadlineOf(const SliceView& slice, const DeadlineRules& rules) {
  const GstClockTime scan = slice.info->ScanDuration();
  const GstClockTime pts = GST_BUFFER_PTS(slice.buffer);
  if (!GST_CLOCK_TIME_IS_VALID(pts) || !GST_CLOCK_TIME_IS_VALID(scan)) return GST_CLOCK_TIME_NONE;
  const GstClockTime before = scan / slice.meta.slice_count * slice.meta.slice_index;
  const GstClockTime running =
      gst_segment_to_running_time(rules.segment, GST_FORMAT_TIME, pts > before ? pts - before : 0);
  if (!GST_CLOCK_TIME_IS_VALID(running)) return GST_CLOCK_TIME_NONE;
  return running + scan + rules.upstream_latency + rules.max_wait;
}

}  // namespace lidar::gst
