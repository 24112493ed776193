// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/lidar/gstlidarcloud.h"

#include "src/cloud/point_fields.h"

gint gst_lidar_cloud_format_get_offset(const GstLidarCloudFormat* cloud, const gchar* name,
                                       const gchar* type) {
  const auto fields = lidar::PointFields::Parse(cloud->fields != nullptr ? cloud->fields : "");
  const auto wanted = lidar::PointFields::Parse(std::string(name) + ":" + type + ":0");
  if (!fields || !wanted || !fields->Has(name, wanted->Find(name)->type)) return -1;
  return static_cast<gint>(fields->Find(name)->offset);
}

GstCaps* gst_lidar_coded_caps_new(const gchar* media_type, const gchar* fields,
                                  const GstLidarCloudFormat* cloud) {
  GstCaps* caps = gst_caps_new_simple(media_type, "alignment", G_TYPE_STRING, "slice", "fields",
                                      G_TYPE_STRING, fields, "framerate", GST_TYPE_FRACTION,
                                      cloud->framerate_n, cloud->framerate_d, nullptr);
  if (cloud->sensor_model != nullptr) {
    gst_caps_set_simple(caps, "sensor-model", GST_TYPE_BUFFER, cloud->sensor_model, nullptr);
  }
  return caps;
}
