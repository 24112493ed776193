// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts the caps of slices to the caps of whole scans.
#pragma once
#include "gst/common/refs.h"
#include "gst/lidar/cloud_info.h"
#include "gst/pointcloud/assembler/scan_builder.h"

namespace lidar::gst {

/// Returns the caps of a scan of `width` columns. `slice` are the caps of its slices.
CapsPtr ScanCaps(const GstCaps* slice, const CloudInfo& slice_info, guint width);
/// Returns true if the caps are equal except for the width.
bool SameButForWidth(const GstCaps* a, const GstCaps* b);
/// Returns true if slices with these infos cannot belong to the same scan.
bool CannotMix(const CloudInfo& a, const CloudInfo& b);

struct DeadlineRules {
  const GstSegment* segment;
  GstClockTime upstream_latency;
  GstClockTime max_wait;
};
/// Returns the running time until which the slice's scan may wait for further slices, or NONE if
/// the slice has no time.
GstClockTime DeadlineOf(const SliceView& slice, const DeadlineRules& rules);

}  // namespace lidar::gst
