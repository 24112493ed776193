// SPDX-License-Identifier: LGPL-2.1-or-later
// screamaux: screamtx for sessions whose receivers report with TWCC, as webrtcbin's do.
#pragma once
#include <gst/gst.h>

G_BEGIN_DECLS

#define GST_TYPE_LIDAR_SCREAM_AUX (gst_lidar_scream_aux_get_type())
G_DECLARE_FINAL_TYPE(GstLidarScreamAux, gst_lidar_scream_aux, GST, LIDAR_SCREAM_AUX, GstBin)
GST_ELEMENT_REGISTER_DECLARE(screamaux)

G_END_DECLS
