// SPDX-License-Identifier: LGPL-2.1-or-later
// Sits behind any encoder and sets its bitrate from target-bitrate events.
#pragma once
#include <gst/base/gstbasetransform.h>

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_BITRATE_ADAPTER (gst_lidar_bitrate_adapter_get_type())
G_DECLARE_FINAL_TYPE(GstLidarBitrateAdapter, gst_lidar_bitrate_adapter, GST, LIDAR_BITRATE_ADAPTER,
                     GstBaseTransform)
GST_ELEMENT_REGISTER_DECLARE(bitrateadapter)
G_END_DECLS
