// SPDX-License-Identifier: LGPL-2.1-or-later
// screamsink: sends RTP under SCReAM congestion control, feedback on the same socket.
#pragma once
#include <gst/gst.h>

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_SCREAM_SINK (gst_lidar_scream_sink_get_type())
G_DECLARE_FINAL_TYPE(GstLidarScreamSink, gst_lidar_scream_sink, GST, LIDAR_SCREAM_SINK, GstBin)
GST_ELEMENT_REGISTER_DECLARE(screamsink)
G_END_DECLS
