// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts the poses of lidarodometry to metas, messages and buffers.
#pragma once
#include <gst/gst.h>

#include "gst/common/pose_covariance.h"
#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"
#include "src/odometry/odometry.h"

namespace lidar::gst {

Covariance CovarianceOf(const odometry::Estimate& estimate);
/// These functions return the square root of the sum of the variances in three directions [m, rad].
double PositionDeviation(const odometry::Estimate& estimate);
double OrientationDeviation(const odometry::Estimate& estimate);
/// Returns the meta of `pose`. Tracking state and covariance are those of `last`, the last aligned
/// scan.
GstLidarPose ToMeta(const odometry::Pose& pose, const odometry::Estimate& last);

/// These functions return the message of a scan and of a closed loop. The caller owns it.
GstStructure* OdometryMessage(const odometry::Estimate& estimate);
GstStructure* LoopMessage(const odometry::Pose& map_from_odometry, std::size_t loops);

/// These functions return buffers with the layout of cdr::WritePose(). The caller owns them.
GstBuffer* PoseBuffer(const odometry::Estimate& estimate, GstClockTime pts);
GstBuffer* MapBuffer(const odometry::Pose& map_from_odometry, Time time, GstClockTime pts);
/// Returns the caps of buffers from MapBuffer(). They contain the names of the frames.
CapsPtr MapCaps();

}  // namespace lidar::gst
