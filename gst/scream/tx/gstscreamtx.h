// SPDX-License-Identifier: LGPL-2.1-or-later
// screamtx: congestion-controls RTP with SCReAM v2.
#pragma once
#include <gst/gst.h>

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_SCREAM_TX (gst_lidar_scream_tx_get_type())
G_DECLARE_FINAL_TYPE(GstLidarScreamTx, gst_lidar_scream_tx, GST, LIDAR_SCREAM_TX, GstElement)
GST_ELEMENT_REGISTER_DECLARE(screamtx)
G_END_DECLS
