// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once
#include <gst/base/gstbasetransform.h>

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_ODOMETRY (gst_lidar_odometry_get_type())
G_DECLARE_FINAL_TYPE(GstLidarOdometry, gst_lidar_odometry, GST, LIDAR_ODOMETRY, GstBaseTransform)
GST_ELEMENT_REGISTER_DECLARE(lidarodometry)
G_END_DECLS
