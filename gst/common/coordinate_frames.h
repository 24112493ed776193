// SPDX-License-Identifier: LGPL-2.1-or-later
// Frames in caps, and the media type of transforms between them.
#pragma once
#include <gst/gst.h>

#include <string>

/// tf2_msgs/msg/TFMessage as ROS 2 has it, in CDR with its encapsulation header. `static`
/// (boolean): the transforms never change.
#define GST_LIDAR_TF_MEDIA_TYPE "application/x-tf"
#define GST_LIDAR_TF_STATIC "static"

// Caps fields: the frame of the data, and the frame whose pose odometry gives.
#define GST_LIDAR_FRAME_ID "frame-id"
#define GST_LIDAR_CHILD_FRAME_ID "child-frame-id"

namespace lidar::gst {

// Default frames: the cloud is in the frame whose pose odometry gives.
inline constexpr const char* kCloudFrame = "lidar";
inline constexpr const char* kImuFrame = "imu";
inline constexpr const char* kOdometryFrame = "odom";
inline constexpr const char* kMapFrame = "map";

/// Returns the frame in a field of caps, or `usual` if they have none.
inline std::string FrameIn(const GstStructure* caps, const char* field, const char* usual = "") {
  const gchar* frame = gst_structure_get_string(caps, field);
  return frame != nullptr ? frame : usual;
}

}  // namespace lidar::gst
