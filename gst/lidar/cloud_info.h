// SPDX-License-Identifier: LGPL-2.1-or-later
// The caps of a raw cloud, parsed: what GstVideoInfo is to video.
#pragma once
#include <gst/gst.h>

#include <optional>
#include <string>

#include "gst/lidar/gstlidarcloud.h"
#include "src/cloud/point_fields.h"
#include "src/cloud/sensor_model.h"

namespace lidar::gst {

/// `application/x-pointcloud2`. Organised: height beams of width columns, row-major.
struct CloudInfo {
  guint width = 0;  // 0: the caps do not fix it (files before pointcloudparse)
  guint height = 1;
  guint point_step = 0;  // bytes
  PointFields fields;
  bool is_dense = false;
  gint framerate_n = 0;  // scans/s; 0/1: not known
  gint framerate_d = 1;
  std::optional<SensorModel> sensor_model;

  /// Returns nothing if the caps are of another type, big-endian or invalid: fields past
  /// point-step, a frame that is too large, a sensor model that does not parse or has another
  /// height. `why` then has the reason in words for a user.
  GST_LIDAR_API static std::optional<CloudInfo> FromCaps(const GstCaps* caps,
                                                         std::string* why = nullptr);
  /// FromCaps() for caps that fix the width as well.
  GST_LIDAR_API static std::optional<CloudInfo> FromFrameCaps(const GstCaps* caps,
                                                              std::string* why = nullptr);
  /// Returns the packed cloud, without its width, that slices of coded caps decode to. Returns
  /// nothing if the caps contradict themselves or lack x, y and z as adjacent F32; without
  /// `fields`, as in a file with the media type alone, these three are the fields.
  GST_LIDAR_API static std::optional<CloudInfo> FromCodedCaps(const GstCaps* caps);
  /// Converts a format that the base class has checked and given to its coder.
  GST_LIDAR_API static CloudInfo FromFormat(const GstLidarCloudFormat& format);
  /// transfer full
  GST_LIDAR_API GstCaps* ToCaps() const;

  gsize FrameSize() const { return gsize{width} * height * point_step; }
  gsize Points() const { return gsize{width} * height; }
  /// Time of one scan, or GST_CLOCK_TIME_NONE.
  GstClockTime ScanDuration() const {
    return framerate_n > 0 ? gst_util_uint64_scale_int(GST_SECOND, framerate_d, framerate_n)
                           : GST_CLOCK_TIME_NONE;
  }
};

/// A sensor model as the value of the caps field `sensor-model`; transfer full.
GST_LIDAR_API GstBuffer* SensorModelToBuffer(const SensorModel& model);
/// Reads the caps field `sensor-model` of `structure`, of any media type.
GST_LIDAR_API std::optional<SensorModel> SensorModelFromStructure(const GstStructure* structure);

}  // namespace lidar::gst
