// SPDX-License-Identifier: LGPL-2.1-or-later
// dracoenc: slices of point clouds of any kind to bytes, by Draco.
#pragma once
#include "gst/common/gstlidarencoder.h"

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_DRACO_ENC (gst_lidar_draco_enc_get_type())
G_DECLARE_FINAL_TYPE(GstLidarDracoEnc, gst_lidar_draco_enc, GST, LIDAR_DRACO_ENC, GstLidarEncoder)
GST_ELEMENT_REGISTER_DECLARE(dracoenc)
G_END_DECLS
