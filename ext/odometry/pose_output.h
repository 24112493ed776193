// SPDX-License-Identifier: LGPL-2.1-or-later
// Poses as lidarodometry gives them: metas, messages, and buffers of its pads.
#pragma once
#include <gst/gst.h>

#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"
#include "src/odometry/odometry.h"

namespace lidar::gst {

GstLidarPose ToMeta(const odometry::Pose& pose, odometry::Tracking tracking);

/// The message of a scan, and that of a loop. The caller owns them.
GstStructure* OdometryMessage(const odometry::Estimate& estimate);
GstStructure* LoopMessage(const odometry::Pose& map_from_odometry, std::size_t loops);

/// Buffers as cdr::WritePose() lays them out. The caller owns them.
GstBuffer* PoseBuffer(const odometry::Estimate& estimate, GstClockTime pts);
GstBuffer* MapBuffer(const odometry::Pose& map_from_odometry, Time time, GstClockTime pts);
/// The caps of MapBuffer(), with its frames.
CapsPtr MapCaps();

}  // namespace lidar::gst
