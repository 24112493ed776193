// SPDX-License-Identifier: LGPL-2.1-or-later
// lidarenc: slices of an organised scan to bytes, by our own coder.
#pragma once
#include "gst/common/gstlidarencoder.h"

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_ENC (gst_lidar_enc_get_type())
G_DECLARE_FINAL_TYPE(GstLidarEnc, gst_lidar_enc, GST, LIDAR_ENC, GstLidarEncoder)
GST_ELEMENT_REGISTER_DECLARE(lidarenc)
G_END_DECLS
