// SPDX-License-Identifier: LGPL-2.1-or-later
// Plugin lidarscream: SCReAM v2 congestion control.
#include "common/gstlidar.h"
#include "scream/gstbitrateadapter.h"
#include "scream/gstscreamrx.h"
#include "scream/gstscreamsink.h"
#include "scream/gstscreamsrc.h"
#include "scream/gstscreamtx.h"

static gboolean plugin_init(GstPlugin* plugin) {
  gst_lidar_init();
  return GST_ELEMENT_REGISTER(screamtx, plugin) && GST_ELEMENT_REGISTER(screamrx, plugin) &&
         GST_ELEMENT_REGISTER(screamsink, plugin) && GST_ELEMENT_REGISTER(screamsrc, plugin) &&
         GST_ELEMENT_REGISTER(bitrateadapter, plugin);
}

GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, lidarscream,
                  "SCReAM v2 congestion control for RTP", plugin_init, VERSION, "LGPL", PACKAGE,
                  "https://gstreamer.freedesktop.org")
