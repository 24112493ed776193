// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once
#include <gst/gst.h>

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_FOXGLOVE_SINK (gst_lidar_foxglove_sink_get_type())
G_DECLARE_FINAL_TYPE(GstLidarFoxgloveSink, gst_lidar_foxglove_sink, GST, LIDAR_FOXGLOVE_SINK,
                     GstBin)
GST_ELEMENT_REGISTER_DECLARE(foxglovesink)
G_END_DECLS
