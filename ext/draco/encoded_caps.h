// SPDX-License-Identifier: LGPL-2.1-or-later
// The caps of encoded slices, parsed.
#pragma once
#include <gst/gst.h>

#include <optional>

#include "src/cloud/point_fields.h"
#include "src/cloud/sensor_model.h"
#include "src/codec/slice_encoder.h"

namespace lidar::gst {

/// `application/x-draco`, one slice a buffer.
struct EncodedInfo {
  codec::Geometry geometry = codec::Geometry::kXyz;  // never kAuto
  PointFields fields;                                // of the decoded cloud
  gint framerate_n = 0;                              // scans/s; 0/1: not known
  gint framerate_d = 1;
  std::optional<SensorModel> sensor_model;  // always there in range geometry

  /// None where the caps are of another type, lack something or contradict themselves.
  static std::optional<EncodedInfo> FromCaps(const GstCaps* caps);
  /// transfer full
  GstCaps* ToCaps() const;
};

}  // namespace lidar::gst
