// SPDX-License-Identifier: LGPL-2.1-or-later
// Registers the elements of the plugin.
#include "gst/lidar/gstlidar.h"

GST_ELEMENT_REGISTER_DECLARE(natssrc)
GST_ELEMENT_REGISTER_DECLARE(natssink)

static gboolean plugin_init(GstPlugin* plugin) {
  gst_lidar_init();
  return GST_ELEMENT_REGISTER(natssink, plugin) && GST_ELEMENT_REGISTER(natssrc, plugin);
}

GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, lidarnats,
                  "Streams of clouds and slices over NATS", plugin_init, VERSION, "LGPL", PACKAGE,
                  PACKAGE_ORIGIN)
