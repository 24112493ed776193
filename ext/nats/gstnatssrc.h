// SPDX-License-Identifier: LGPL-2.1-or-later
// natssrc: messages of NATS as the stream of buffers that natssink got.
#pragma once
#include <gst/base/gstpushsrc.h>

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_NATS_SRC (gst_lidar_nats_src_get_type())
G_DECLARE_FINAL_TYPE(GstLidarNatsSrc, gst_lidar_nats_src, GST, LIDAR_NATS_SRC, GstPushSrc)
GST_ELEMENT_REGISTER_DECLARE(natssrc)
G_END_DECLS
