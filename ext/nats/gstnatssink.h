// SPDX-License-Identifier: LGPL-2.1-or-later
// natssink: a stream of buffers as messages of NATS.
#pragma once
#include <gst/base/gstbasesink.h>

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_NATS_SINK (gst_lidar_nats_sink_get_type())
G_DECLARE_FINAL_TYPE(GstLidarNatsSink, gst_lidar_nats_sink, GST, LIDAR_NATS_SINK, GstBaseSink)
GST_ELEMENT_REGISTER_DECLARE(natssink)
G_END_DECLS
