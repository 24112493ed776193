// SPDX-License-Identifier: LGPL-2.1-or-later
// Poses on buffers, as Foxglove has them.
#pragma once
#include <algorithm>

#include "gst/lidar/gstlidar.h"
#include "src/foxglove/messages.h"

namespace lidar::web {

inline constexpr const char* kFixedFrame = "odom";

inline foxglove::Pose PoseOf(const GstLidarPose& meta) {
  foxglove::Pose pose;
  std::copy_n(meta.position, pose.position.size(), pose.position.begin());
  std::copy_n(meta.orientation, pose.orientation.size(), pose.orientation.begin());
  return pose;
}

}  // namespace lidar::web
