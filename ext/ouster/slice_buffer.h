// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts slices to GStreamer buffers.
#pragma once
#include <gst/gst.h>

#include "src/ouster/sensor_stream.h"

namespace lidar::gst {

/// Time since the Unix epoch; 0 for a time before it.
GstClockTime ToClockTime(Time time);
/// transfer full
GstCaps* CapsOf(const ouster::SensorStream& stream);
/// Takes the points without a copy. PTS is slice.local, counted from the zero of its clock;
/// transfer full.
GstBuffer* ToBuffer(ouster::TimedSlice slice, Duration duration);

}  // namespace lidar::gst
