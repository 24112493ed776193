// SPDX-License-Identifier: LGPL-2.1-or-later
// The parsed caps of a raw cloud, as GstVideoInfo is for video.
#pragma once
#include <gst/gst.h>

#include <optional>
#include <string>

#include "gst/lidar/gstlidarcloud.h"
#include "src/cloud/point_fields.h"
#include "src/cloud/sensor_model.h"

namespace lidar::gst {

/// The contents of `application/x-pointcloud2`. An organised cloud has `height` beams and `width`
/// columns, and is stored row by row.
struct CloudInfo {
  guint width = 0;  // 0: unknown (files before pointcloudparse)
  guint height = 1;
  guint point_step = 0;  // bytes
  PointFields fields;
  bool is_dense = false;
  gint framerate_n = 0;  // scans/s; 0/1: not known
  gint framerate_d = 1;
  std::optional<SensorModel> sensor_model;

  /// Parses caps. Returns nothing and sets `why`, a text for users, if the caps are of another
  /// type, big-endian or invalid. They are invalid if a field extends past point-step, if the frame
  /// is too large, or if the sensor model is damaged or has another height.
  GST_LIDAR_API static std::optional<CloudInfo> FromCaps(const GstCaps* caps,
                                                         std::string* why = nullptr);
  /// Parses caps like FromCaps(), and requires that they also have a width.
  GST_LIDAR_API static std::optional<CloudInfo> FromFrameCaps(const GstCaps* caps,
                                                              std::string* why = nullptr);
  /// Returns the decoded cloud, without a width, for the caps of coded slices. The points of this
  /// cloud have no gaps. If the caps have no `fields`, as in a file that has only the media type,
  /// the fields are x, y and z. Returns nothing if the caps are contradictory or do not have x, y
  /// and z as adjacent F32.
  GST_LIDAR_API static std::optional<CloudInfo> FromCodedCaps(const GstCaps* caps);
  /// Converts a format that the base class has checked and passed to its subclass.
  GST_LIDAR_API static CloudInfo FromFormat(const GstLidarCloudFormat& format);
  /// Returns the caps of the cloud (transfer full).
  GST_LIDAR_API GstCaps* ToCaps() const;

  gsize FrameSize() const { return gsize{width} * height * point_step; }
  gsize Points() const { return gsize{width} * height; }
  /// Returns the duration of one scan, or GST_CLOCK_TIME_NONE if it is unknown.
  GstClockTime ScanDuration() const {
    return framerate_n > 0 ? gst_util_uint64_scale_int(GST_SECOND, framerate_d, framerate_n)
                           : GST_CLOCK_TIME_NONE;
  }
};

/// Returns the value of the caps field `sensor-model` (transfer full).
GST_LIDAR_API GstBuffer* SensorModelToBuffer(const SensorModel& model);
/// Reads the caps field `sensor-model` of `structure`, which may have any media type.
GST_LIDAR_API std::optional<SensorModel> SensorModelFromStructure(const GstStructure* structure);

}  // namespace lidar::gst
