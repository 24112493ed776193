// SPDX-License-Identifier: LGPL-2.1-or-later
// The caps of coded slices, and the facts that viewers get from them.
#pragma once
#include <gst/gst.h>

#include <optional>
#include <string>

#include "gst/lidar/cloud_info.h"
#include "src/foxglove/protocol.h"

namespace lidar::web {

struct SliceCaps {
  gst::CloudInfo info;              // of the decoded clouds
  foxglove::SliceStreamInfo about;  // without frame and topic

  /// Returns nothing and sets `why` if the caps are not those of slices to decode.
  static std::optional<SliceCaps> Parse(const GstCaps* caps, std::string* why);
  /// Returns true if one decoder takes the slices of both.
  bool HasSameDecoder(const SliceCaps& other) const {
    return about.has_ranges == other.about.has_ranges && about.fields == other.about.fields &&
           about.sensor_model == other.about.sensor_model;
  }
};

}  // namespace lidar::web
