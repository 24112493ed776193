// SPDX-License-Identifier: LGPL-2.1-or-later
// screamsrc: receives RTP under SCReAM congestion control, feedback on the same socket.
#pragma once
#include <gst/gst.h>

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_SCREAM_SRC (gst_lidar_scream_src_get_type())
G_DECLARE_FINAL_TYPE(GstLidarScreamSrc, gst_lidar_scream_src, GST, LIDAR_SCREAM_SRC, GstBin)
GST_ELEMENT_REGISTER_DECLARE(screamsrc)
G_END_DECLS
