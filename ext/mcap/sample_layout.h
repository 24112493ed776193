// SPDX-License-Identifier: LGPL-2.1-or-later
// Which samples of an IMU can be recorded, and how a recording says whether a pose is to be
// believed.
#pragma once
#include <gst/gst.h>

#include "gst/common/gstlidar.h"
#include "src/cdr/messages.h"

namespace lidar::gst {

bool IsOurImu(const GstCaps* caps);

/// ROS has no word for the tracking: a pose that is not to be believed has a large covariance.
void SetTracking(std::uint64_t tracking, cdr::Odometry* odometry);
GstLidarTracking TrackingOf(const cdr::Odometry& odometry);

}  // namespace lidar::gst
