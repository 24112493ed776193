// SPDX-License-Identifier: LGPL-2.1-or-later
// dracoenc: clouds to Draco slices.
#pragma once
#include <gst/gst.h>

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_DRACO_ENC (gst_lidar_draco_enc_get_type())
G_DECLARE_FINAL_TYPE(GstLidarDracoEnc, gst_lidar_draco_enc, GST, LIDAR_DRACO_ENC, GstElement)
GST_ELEMENT_REGISTER_DECLARE(dracoenc)
G_END_DECLS
