// SPDX-License-Identifier: LGPL-2.1-or-later
// Crops, thins, moves and converts clouds.
#pragma once
#include <gst/gst.h>

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_POINT_CLOUD_FILTER (gst_lidar_point_cloud_filter_get_type())
G_DECLARE_FINAL_TYPE(GstLidarPointCloudFilter, gst_lidar_point_cloud_filter, GST,
                     LIDAR_POINT_CLOUD_FILTER, GstElement)
GST_ELEMENT_REGISTER_DECLARE(pointcloudfilter)
G_END_DECLS
