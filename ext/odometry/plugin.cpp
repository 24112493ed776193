// SPDX-License-Identifier: LGPL-2.1-or-later
// Registers the elements of the plugin.
#include "gst/lidar/gstlidar.h"

GST_ELEMENT_REGISTER_DECLARE(lidarodometry)

static gboolean plugin_init(GstPlugin* plugin) {
  gst_lidar_init();
  return GST_ELEMENT_REGISTER(lidarodometry, plugin);
}

GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, lidarodometry, "Odometry from point clouds",
                  plugin_init, VERSION, "LGPL", PACKAGE, PACKAGE_ORIGIN)
