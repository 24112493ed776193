// SPDX-License-Identifier: LGPL-2.1-or-later
// The fields for coordinate frames in caps, and the media type of transforms between frames.
#pragma once
#include <gst/gst.h>

#include <string>

/// A tf2_msgs/msg/TFMessage of ROS 2, in CDR with the encapsulation header. If the boolean field
/// `static` is true, the transforms never change.
#define GST_LIDAR_TF_MEDIA_TYPE "application/x-tf"
#define GST_LIDAR_TF_STATIC "static"

// Fields of caps: the frame of the data, and for odometry the frame whose pose is given.
#define GST_LIDAR_FRAME_ID "frame-id"
#define GST_LIDAR_CHILD_FRAME_ID "child-frame-id"

namespace lidar::gst {

// The default frames. The default frame of clouds is also the frame whose pose odometry gives.
inline constexpr const char* kCloudFrame = "lidar";
inline constexpr const char* kImuFrame = "imu";
inline constexpr const char* kOdometryFrame = "odom";
inline constexpr const char* kMapFrame = "map";

/// Returns the frame in a field of the caps, or `usual` if the caps do not have the field.
inline std::string FrameIn(const GstStructure* caps, const char* field, const char* usual = "") {
  const gchar* frame = gst_structure_get_string(caps, field);
  return frame != nullptr ? frame : usual;
}

}  // namespace lidar::gst
