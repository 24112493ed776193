// SPDX-License-Identifier: LGPL-2.1-or-later
// Registers the elements of the plugin.
#include "ext/ros2/gstros2sink.h"
#include "ext/ros2/gstros2src.h"
#include "gst/common/gstlidar.h"

static gboolean plugin_init(GstPlugin* plugin) {
  gst_lidar_init();
  return GST_ELEMENT_REGISTER(ros2src, plugin) && GST_ELEMENT_REGISTER(ros2sink, plugin);
}

GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, ros2, "Clouds to and from ROS 2 nodes",
                  plugin_init, VERSION, "LGPL", PACKAGE, PACKAGE_ORIGIN)
