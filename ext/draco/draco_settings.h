// SPDX-License-Identifier: LGPL-2.1-or-later
// What a user sets of dracoenc alone.
#pragma once
#include <gst/gst.h>

#include <optional>

#include "src/cloud/coded_geometry.h"
#include "src/codec/range_header.h"

namespace lidar::gst {

enum class GeometryChoice : gint { kAuto, kXyz, kRange };

struct DracoSettings {
  GeometryChoice geometry = GeometryChoice::kAuto;
  codec::RangeCoder range_coder = codec::RangeCoder::kResidual;
  guint level = 7;

  /// None: range where the cloud has ranges.
  std::optional<Geometry> wanted_geometry() const {
    if (geometry == GeometryChoice::kAuto) return std::nullopt;
    return geometry == GeometryChoice::kRange ? Geometry::kRange : Geometry::kXyz;
  }
};

GType DracoGeometryType();
GType DracoRangeCoderType();

}  // namespace lidar::gst
