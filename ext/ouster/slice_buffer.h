// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts slices to GStreamer buffers.
#pragma once
#include <gst/gst.h>

#include "src/ouster/sensor_stream.h"

namespace lidar::gst {

/// Returns the time since the Unix epoch, or 0 for a time before the epoch.
GstClockTime ToClockTime(Time time);
/// Returns the caps of the stream's buffers (transfer full).
GstCaps* CapsOf(const ouster::SensorStream& stream);
/// Converts the slice to a buffer (transfer full). The points are not copied. The PTS is
/// slice.local, counted from the epoch of its clock.
GstBuffer* ToBuffer(ouster::TimedSlice slice, Duration duration);

}  // namespace lidar::gst
