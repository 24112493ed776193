// SPDX-License-Identifier: LGPL-2.1-or-later
// lidardec: what lidarenc encodes, back to slices of an organised scan.
#pragma once
#include "gst/common/gstlidardecoder.h"

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_DEC (gst_lidar_dec_get_type())
G_DECLARE_FINAL_TYPE(GstLidarDec, gst_lidar_dec, GST, LIDAR_DEC, GstLidarDecoder)
GST_ELEMENT_REGISTER_DECLARE(lidardec)
G_END_DECLS
