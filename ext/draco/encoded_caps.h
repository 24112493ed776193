// SPDX-License-Identifier: LGPL-2.1-or-later
// The caps of encoded slices, parsed.
#pragma once
#include <gst/gst.h>

#include <optional>

#include "src/cloud/geometry.h"
#include "src/cloud/point_fields.h"
#include "src/cloud/sensor_model.h"

namespace lidar::gst {

/// `application/x-draco`, one slice a buffer.
struct EncodedInfo {
  Geometry geometry = Geometry::kXyz;
  PointFields fields;    // of the decoded cloud
  gint framerate_n = 0;  // scans/s; 0/1: not known
  gint framerate_d = 1;
  std::optional<SensorModel> sensor_model;  // always there in range geometry

  /// None where the caps are of another type, lack something or contradict themselves.
  static std::optional<EncodedInfo> FromCaps(const GstCaps* caps);
  /// transfer full
  GstCaps* ToCaps() const;
};

}  // namespace lidar::gst
