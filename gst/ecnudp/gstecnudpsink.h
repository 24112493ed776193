// SPDX-License-Identifier: LGPL-2.1-or-later
// ecnudpsink: sends each buffer as one UDP datagram with its own ECN codepoint.
#pragma once
#include <gst/base/gstbasesink.h>

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_ECN_UDP_SINK (gst_lidar_ecn_udp_sink_get_type())
G_DECLARE_FINAL_TYPE(GstLidarEcnUdpSink, gst_lidar_ecn_udp_sink, GST, LIDAR_ECN_UDP_SINK,
                     GstBaseSink)
GST_ELEMENT_REGISTER_DECLARE(ecnudpsink)
G_END_DECLS
