// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once
#include <gst/gst.h>

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_POINT_CLOUD_PARSE (gst_lidar_point_cloud_parse_get_type())
G_DECLARE_FINAL_TYPE(GstLidarPointCloudParse, gst_lidar_point_cloud_parse, GST,
                     LIDAR_POINT_CLOUD_PARSE, GstElement)
GST_ELEMENT_REGISTER_DECLARE(pointcloudparse)
G_END_DECLS
