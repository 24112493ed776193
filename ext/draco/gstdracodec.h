// SPDX-License-Identifier: LGPL-2.1-or-later
// dracodec: what dracoenc encodes, and plain Draco files, back to slices of point clouds.
#pragma once
#include "gst/common/gstlidardecoder.h"

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_DRACO_DEC (gst_lidar_draco_dec_get_type())
G_DECLARE_FINAL_TYPE(GstLidarDracoDec, gst_lidar_draco_dec, GST, LIDAR_DRACO_DEC, GstLidarDecoder)
GST_ELEMENT_REGISTER_DECLARE(dracodec)
G_END_DECLS
