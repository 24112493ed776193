// SPDX-License-Identifier: LGPL-2.1-or-later
// Makes one cloud of the scans of several sensors.
#pragma once
#include <gst/base/gstaggregator.h>

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_POINT_CLOUD_MERGE (gst_lidar_point_cloud_merge_get_type())
G_DECLARE_FINAL_TYPE(GstLidarPointCloudMerge, gst_lidar_point_cloud_merge, GST,
                     LIDAR_POINT_CLOUD_MERGE, GstAggregator)
GST_ELEMENT_REGISTER_DECLARE(pointcloudmerge)
G_END_DECLS
