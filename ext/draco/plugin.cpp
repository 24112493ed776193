// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/lidar/gstlidar.h"

GST_ELEMENT_REGISTER_DECLARE(dracodec)
GST_ELEMENT_REGISTER_DECLARE(dracoenc)

static gboolean plugin_init(GstPlugin* plugin) {
  gst_lidar_init();
  return GST_ELEMENT_REGISTER(dracoenc, plugin) && GST_ELEMENT_REGISTER(dracodec, plugin);
}

GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, lidardraco,
                  "Point clouds compressed by Draco, within an error bound", plugin_init, VERSION,
                  "LGPL", PACKAGE, PACKAGE_ORIGIN)
