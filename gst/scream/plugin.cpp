// SPDX-License-Identifier: LGPL-2.1-or-later
// Plugin lidarscream: SCReAM v2 congestion control.
#include "gst/lidar/gstlidar.h"
#include "gst/scream/rx/gstscreamrx.h"
#include "gst/scream/tx/gstscreamtx.h"

GST_ELEMENT_REGISTER_DECLARE(screamaux)
GST_ELEMENT_REGISTER_DECLARE(screamsrc)
GST_ELEMENT_REGISTER_DECLARE(screamsink)
GST_ELEMENT_REGISTER_DECLARE(bitrateadapter)

static gboolean plugin_init(GstPlugin* plugin) {
  gst_lidar_init();
  return GST_ELEMENT_REGISTER(screamtx, plugin) && GST_ELEMENT_REGISTER(screamrx, plugin) &&
         GST_ELEMENT_REGISTER(screamsink, plugin) && GST_ELEMENT_REGISTER(screamsrc, plugin) &&
         GST_ELEMENT_REGISTER(screamaux, plugin) && GST_ELEMENT_REGISTER(bitrateadapter, plugin);
}

GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, lidarscream,
                  "SCReAM v2 congestion control for RTP", plugin_init, VERSION, "LGPL", PACKAGE,
                  PACKAGE_ORIGIN)
