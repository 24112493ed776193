// SPDX-License-Identifier: LGPL-2.1-or-later
// How samples of an IMU and poses stand in buffers, and what of it ROS messages can say.
#pragma once
#include <gst/gst.h>

#include "gst/common/gstlidar.h"
#include "src/cdr/messages.h"

namespace lidar::gst {

/// `application/x-imu`: a time and six floats.
constexpr gsize kImuSampleSize = 32;
constexpr const char* kImuFields =
    "t:U64:0,ax:F32:8,ay:F32:12,az:F32:16,gx:F32:20,gy:F32:24,gz:F32:28";
bool IsOurImu(const GstCaps* caps);

/// `application/x-odometry`: seven doubles and the tracking.
constexpr gsize kOdometrySize = 64;
/// ROS has no word for the tracking: a pose that is not to be believed has a large covariance.
void SetTracking(GstLidarTracking tracking, cdr::Odometry* odometry);
GstLidarTracking TrackingOf(const cdr::Odometry& odometry);

}  // namespace lidar::gst
