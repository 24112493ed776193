// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once
#include <gst/base/gstpushsrc.h>

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_OUSTER_SRC (gst_lidar_ouster_src_get_type())
G_DECLARE_FINAL_TYPE(GstLidarOusterSrc, gst_lidar_ouster_src, GST, LIDAR_OUSTER_SRC, GstPushSrc)
GST_ELEMENT_REGISTER_DECLARE(ouster_src)
G_END_DECLS
