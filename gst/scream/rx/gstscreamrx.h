// SPDX-License-Identifier: LGPL-2.1-or-later
// screamrx: reports what arrives to the SCReAM sender (RFC 8888).
#pragma once
#include <gst/gst.h>

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_SCREAM_RX (gst_lidar_scream_rx_get_type())
G_DECLARE_FINAL_TYPE(GstLidarScreamRx, gst_lidar_scream_rx, GST, LIDAR_SCREAM_RX, GstElement)
GST_ELEMENT_REGISTER_DECLARE(screamrx)
G_END_DECLS
