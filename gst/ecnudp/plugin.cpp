// SPDX-License-Identifier: LGPL-2.1-or-later
// Plugin ecnudp: UDP elements that set and read the ECN field.
#include "gst/lidar/gstlidar.h"

GST_ELEMENT_REGISTER_DECLARE(ecnudpsrc)
GST_ELEMENT_REGISTER_DECLARE(ecnudpsink)

static gboolean plugin_init(GstPlugin* plugin) {
  gst_lidar_init();
  return GST_ELEMENT_REGISTER(ecnudpsink, plugin) && GST_ELEMENT_REGISTER(ecnudpsrc, plugin);
}

GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, ecnudp,
                  "UDP sink and source with the ECN field", plugin_init, VERSION, "LGPL", PACKAGE,
                  PACKAGE_ORIGIN)
