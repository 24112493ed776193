// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once
#include <gst/base/gstbasetransform.h>

#include <string>

#include "gst/pointcloud/cloud_file.h"

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_CLOUD_FILE_ENC (gst_lidar_cloud_file_enc_get_type())
G_DECLARE_DERIVABLE_TYPE(GstLidarCloudFileEnc, gst_lidar_cloud_file_enc, GST, LIDAR_CLOUD_FILE_ENC,
                         GstBaseTransform)

struct _GstLidarCloudFileEncClass {
  GstBaseTransformClass parent;
  std::string (*write)(const lidar::gst::CloudFileInput& cloud);
};

#define GST_TYPE_LIDAR_PCD_ENC (gst_lidar_pcd_enc_get_type())
G_DECLARE_FINAL_TYPE(GstLidarPcdEnc, gst_lidar_pcd_enc, GST, LIDAR_PCD_ENC, GstLidarCloudFileEnc)
GST_ELEMENT_REGISTER_DECLARE(pcdenc)

#define GST_TYPE_LIDAR_PLY_ENC (gst_lidar_ply_enc_get_type())
G_DECLARE_FINAL_TYPE(GstLidarPlyEnc, gst_lidar_ply_enc, GST, LIDAR_PLY_ENC, GstLidarCloudFileEnc)
GST_ELEMENT_REGISTER_DECLARE(plyenc)
G_END_DECLS
