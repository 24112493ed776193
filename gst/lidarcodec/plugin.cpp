// SPDX-License-Identifier: LGPL-2.1-or-later
// Registers the elements of the plugin lidarcodec, our own coder for the clouds of LiDAR sensors.
#include "gst/lidar/gstlidar.h"

GST_ELEMENT_REGISTER_DECLARE(lidardec)
GST_ELEMENT_REGISTER_DECLARE(lidarenc)

static gboolean plugin_init(GstPlugin* plugin) {
  gst_lidar_init();
  return GST_ELEMENT_REGISTER(lidarenc, plugin) && GST_ELEMENT_REGISTER(lidardec, plugin);
}

GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, lidarcodec,
                  "LiDAR scans compressed within an error bound", plugin_init, VERSION, "LGPL",
                  PACKAGE, PACKAGE_ORIGIN)
