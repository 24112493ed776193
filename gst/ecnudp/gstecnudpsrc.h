// SPDX-License-Identifier: LGPL-2.1-or-later
// ecnudpsrc: receives UDP datagrams with their ECN codepoint and kernel arrival time.
#pragma once
#include <gst/base/gstpushsrc.h>

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_ECN_UDP_SRC (gst_lidar_ecn_udp_src_get_type())
G_DECLARE_FINAL_TYPE(GstLidarEcnUdpSrc, gst_lidar_ecn_udp_src, GST, LIDAR_ECN_UDP_SRC, GstPushSrc)
GST_ELEMENT_REGISTER_DECLARE(ecnudpsrc)
G_END_DECLS
