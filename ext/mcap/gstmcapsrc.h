// SPDX-License-Identifier: LGPL-2.1-or-later
// Plays MCAP files.
#pragma once
#include <gst/gst.h>

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_MCAP_SRC (gst_lidar_mcap_src_get_type())
G_DECLARE_FINAL_TYPE(GstLidarMcapSrc, gst_lidar_mcap_src, GST, LIDAR_MCAP_SRC, GstElement)
GST_ELEMENT_REGISTER_DECLARE(mcapsrc)
G_END_DECLS
