// SPDX-License-Identifier: LGPL-2.1-or-later
// Registers the elements of the plugin.
#include <curl/curl.h>

#include "gst/lidar/gstlidar.h"

GST_ELEMENT_REGISTER_DECLARE(ouster_src)

static gboolean plugin_init(GstPlugin* plugin) {
  gst_lidar_init();
  // curl counts calls of this function. There is no cleanup, because the plugin is never unloaded.
  if (curl_global_init(CURL_GLOBAL_DEFAULT) != CURLE_OK) return FALSE;
  return GST_ELEMENT_REGISTER(ouster_src, plugin);
}

GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, ouster, "Ouster LiDAR sensors", plugin_init,
                  VERSION, "LGPL", PACKAGE, PACKAGE_ORIGIN)
