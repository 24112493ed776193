// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once
#include <gst/base/gstbasetransform.h>

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_POINT_CLOUD_VIEW (gst_lidar_point_cloud_view_get_type())
G_DECLARE_FINAL_TYPE(GstLidarPointCloudView, gst_lidar_point_cloud_view, GST,
                     LIDAR_POINT_CLOUD_VIEW, GstBaseTransform)
GST_ELEMENT_REGISTER_DECLARE(pointcloudview)
G_END_DECLS
