// SPDX-License-Identifier: LGPL-2.1-or-later
// ros2sink: publishes clouds and motion for ROS 2 nodes.
#pragma once
#include <gst/base/gstbasesink.h>

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_ROS2_SINK (gst_lidar_ros2_sink_get_type())
G_DECLARE_FINAL_TYPE(GstLidarRos2Sink, gst_lidar_ros2_sink, GST, LIDAR_ROS2_SINK, GstBaseSink)
GST_ELEMENT_REGISTER_DECLARE(ros2sink)
G_END_DECLS
