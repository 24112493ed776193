// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/lidar/gstlidar.h"

GST_ELEMENT_REGISTER_DECLARE(lidartestsrc)

static gboolean plugin_init(GstPlugin* plugin) {
  gst_lidar_init();
  return GST_ELEMENT_REGISTER(lidartestsrc, plugin);
}

GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, lidartestsrc,
                  "A synthetic LiDAR in a synthetic world", plugin_init, VERSION, "LGPL", PACKAGE,
                  PACKAGE_ORIGIN)
