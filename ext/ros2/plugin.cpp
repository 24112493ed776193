// SPDX-License-Identifier: LGPL-2.1-or-later
// Registers the elements of the plugin.
#include "gst/lidar/gstlidar.h"

GST_ELEMENT_REGISTER_DECLARE(ros2src)
GST_ELEMENT_REGISTER_DECLARE(ros2sink)

static gboolean plugin_init(GstPlugin* plugin) {
  gst_lidar_init();
  return GST_ELEMENT_REGISTER(ros2src, plugin) && GST_ELEMENT_REGISTER(ros2sink, plugin);
}

GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, ros2, "Clouds to and from ROS 2 nodes",
                  plugin_init, VERSION, "LGPL", PACKAGE, PACKAGE_ORIGIN)
