// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/lidar/gstlidar.h"
#include "gst/pointcloud/parse/cloud_file_reader.h"

GST_ELEMENT_REGISTER_DECLARE(pointcloudmerge)
GST_ELEMENT_REGISTER_DECLARE(pointcloudfilter)
GST_ELEMENT_REGISTER_DECLARE(pcdenc)
GST_ELEMENT_REGISTER_DECLARE(plyenc)
GST_ELEMENT_REGISTER_DECLARE(scanassembler)
GST_ELEMENT_REGISTER_DECLARE(pointcloudparse)

static gboolean plugin_init(GstPlugin* plugin) {
  gst_lidar_init();
  return GST_ELEMENT_REGISTER(pcdenc, plugin) && GST_ELEMENT_REGISTER(plyenc, plugin) &&
         GST_ELEMENT_REGISTER(pointcloudfilter, plugin) &&
         GST_ELEMENT_REGISTER(pointcloudmerge, plugin) &&
         GST_ELEMENT_REGISTER(pointcloudparse, plugin) &&
         GST_ELEMENT_REGISTER(scanassembler, plugin) && lidar::gst::RegisterCloudFileTypes(plugin);
}

GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, lidarpointcloud,
                  "Raw point clouds: from files, from slices, to files", plugin_init, VERSION,
                  "LGPL", PACKAGE, PACKAGE_ORIGIN)
