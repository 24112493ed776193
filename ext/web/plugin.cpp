// SPDX-License-Identifier: LGPL-2.1-or-later
// Registers the elements of the plugin.
#include "gst/lidar/gstlidar.h"

GST_ELEMENT_REGISTER_DECLARE(foxglovesink)

static gboolean plugin_init(GstPlugin* plugin) {
  gst_lidar_init();
  return GST_ELEMENT_REGISTER(foxglovesink, plugin);
}

GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, lidarweb, "Point clouds in browsers",
                  plugin_init, VERSION, "LGPL", PACKAGE, PACKAGE_ORIGIN)
