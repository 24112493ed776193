// SPDX-License-Identifier: LGPL-2.1-or-later
// Writes lidarodometry's poses as metas, messages and buffers.
#pragma once
#include <gst/gst.h>

#include "gst/common/pose_covariance.h"
#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"
#include "src/odometry/odometry.h"

namespace lidar::gst {

Covariance CovarianceOf(const odometry::Estimate& estimate);
/// Return the roots of the sums of the variances in three directions [m, rad].
double PositionDeviation(const odometry::Estimate& estimate);
double OrientationDeviation(const odometry::Estimate& estimate);
/// Returns the meta of `pose`, with the confidence of `last`, the scan before it.
GstLidarPose ToMeta(const odometry::Pose& pose, const odometry::Estimate& last);

/// Return the messages of a scan and of a loop. The caller owns them.
GstStructure* OdometryMessage(const odometry::Estimate& estimate);
GstStructure* LoopMessage(const odometry::Pose& map_from_odometry, std::size_t loops);

/// Return buffers in the layout of cdr::WritePose(). The caller owns them.
GstBuffer* PoseBuffer(const odometry::Estimate& estimate, GstClockTime pts);
GstBuffer* MapBuffer(const odometry::Pose& map_from_odometry, Time time, GstClockTime pts);
/// Returns the caps of MapBuffer(), with its frames.
CapsPtr MapCaps();

}  // namespace lidar::gst
