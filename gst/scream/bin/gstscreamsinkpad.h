// SPDX-License-Identifier: LGPL-2.1-or-later
// A sink pad of screamsink: the ghost of one of screamtx, with its properties.
#pragma once
#include <gst/gst.h>

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_SCREAM_SINK_PAD (gst_lidar_scream_sink_pad_get_type())
G_DECLARE_FINAL_TYPE(GstLidarScreamSinkPad, gst_lidar_scream_sink_pad, GST, LIDAR_SCREAM_SINK_PAD,
                     GstGhostPad)
G_END_DECLS
