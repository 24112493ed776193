// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts poses to Foxglove's types.
#pragma once
#include <algorithm>
#include <memory>
#include <string>

#include "ext/web/topic.h"
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

/// Returns a pose as a message between the slices of a replay. Its time is the time of the header.
inline std::shared_ptr<SliceMessage> PoseMessage(const foxglove::Header& header,
                                                 const std::string& child,
                                                 const foxglove::Pose& pose) {
  auto message = std::make_shared<SliceMessage>();
  message->is_pose = true;
  message->unix_ns = header.unix_ns;
  message->payload = foxglove::EncodeTransform(header, child, pose);
  return message;
}

}  // namespace lidar::web
