// SPDX-License-Identifier: LGPL-2.1-or-later
// Registers the elements of the plugin.
#include "ext/mcap/gstmcapsink.h"
#include "gst/lidar/gstlidar.h"

GST_ELEMENT_REGISTER_DECLARE(mcapsrc)

static gboolean plugin_init(GstPlugin* plugin) {
  gst_lidar_init();
  return GST_ELEMENT_REGISTER(mcapsink, plugin) && GST_ELEMENT_REGISTER(mcapsrc, plugin);
}

GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, lidarmcap, "Recordings as MCAP files",
                  plugin_init, VERSION, "LGPL", PACKAGE, PACKAGE_ORIGIN)
