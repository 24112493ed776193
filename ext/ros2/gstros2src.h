// SPDX-License-Identifier: LGPL-2.1-or-later
// ros2src: what ROS 2 nodes publish, as clouds and motion.
#pragma once
#include <gst/base/gstpushsrc.h>

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_ROS2_SRC (gst_lidar_ros2_src_get_type())
G_DECLARE_FINAL_TYPE(GstLidarRos2Src, gst_lidar_ros2_src, GST, LIDAR_ROS2_SRC, GstPushSrc)
GST_ELEMENT_REGISTER_DECLARE(ros2src)
G_END_DECLS
