// SPDX-License-Identifier: LGPL-2.1-or-later
// A sensor of pointcloudmerge: where it is, and its clouds as all of them are wanted.
#pragma once
#include <gst/base/gstaggregator.h>

#include <optional>
#include <string>

#include "gst/common/refs.h"

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_POINT_CLOUD_MERGE_PAD (gst_lidar_point_cloud_merge_pad_get_type())
G_DECLARE_FINAL_TYPE(GstLidarPointCloudMergePad, gst_lidar_point_cloud_merge_pad, GST,
                     LIDAR_POINT_CLOUD_MERGE_PAD, GstAggregatorPad)
G_END_DECLS

namespace lidar::gst {

/// All are for the thread that aggregates.
void MergePadSetCaps(GstLidarPointCloudMergePad* pad, GstCaps* caps);
/// The returns in `buffer` with `fields`, in the common frame; null where that cannot be: `why`
/// then says so in words for a user. No fields: those of the cloud.
BufferPtr MergePadRead(GstLidarPointCloudMergePad* pad, GstBuffer* buffer,
                       const std::string& fields, std::string* why);
/// Fields of what MergePadRead() gives, as caps have them; none before.
std::optional<std::string> MergePadFields(GstLidarPointCloudMergePad* pad);

}  // namespace lidar::gst
