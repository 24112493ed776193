// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/lidar/gstlidar.h"

GST_ELEMENT_REGISTER_DECLARE(pointcloudview)

static gboolean plugin_init(GstPlugin* plugin) {
  gst_lidar_init();
  return GST_ELEMENT_REGISTER(pointcloudview, plugin);
}

GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, lidarview, "Point clouds as video",
                  plugin_init, VERSION, "LGPL", PACKAGE, PACKAGE_ORIGIN)
