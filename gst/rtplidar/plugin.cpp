// SPDX-License-Identifier: LGPL-2.1-or-later
// Registers the elements of the plugin rtplidar, which sends clouds over RTP.
#include "gst/lidar/gstlidar.h"

GST_ELEMENT_REGISTER_DECLARE(rtplidarpay)
GST_ELEMENT_REGISTER_DECLARE(rtplidardepay)

static gboolean plugin_init(GstPlugin* plugin) {
  gst_lidar_init();
  return GST_ELEMENT_REGISTER(rtplidarpay, plugin) && GST_ELEMENT_REGISTER(rtplidardepay, plugin);
}

GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, rtplidar,
                  "RTP payload format of encoded point clouds", plugin_init, VERSION, "LGPL",
                  PACKAGE, PACKAGE_ORIGIN)
