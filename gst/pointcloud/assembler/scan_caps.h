// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts the caps of slices to those of the scans made of them.
#pragma once
#include "gst/common/refs.h"
#include "gst/lidar/cloud_info.h"
#include "gst/pointcloud/assembler/scan_builder.h"

namespace lidar::gst {

/// Caps of a scan of `width` columns whose slices have the caps `slice`.
CapsPtr ScanCaps(const GstCaps* slice, const CloudInfo& slice_info, guint width);
/// Returns true if the caps are equal except for the width.
bool SameButForWidth(const GstCaps* a, const GstCaps* b);
/// Returns true if slices with these two caps cannot belong to one scan.
bool CannotMix(const CloudInfo& a, const CloudInfo& b);

struct DeadlineRules {
  const GstSegment* segment;
  GstClockTime upstream_latency;
  GstClockTime max_wait;
};
/// Running time until which the scan of a slice may wait; NONE if its times are not known.
GstClockTime DeadlineOf(const SliceView& slice, const DeadlineRules& rules);

}  // namespace lidar::gst
