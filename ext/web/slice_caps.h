// SPDX-License-Identifier: LGPL-2.1-or-later
// The caps of coded slices, and the information in them that viewers need.
#pragma once
#include <gst/gst.h>

#include <optional>
#include <string>

#include "gst/lidar/cloud_info.h"
#include "src/foxglove/protocol.h"

namespace lidar::web {

struct SliceCaps {
  gst::CloudInfo info;              // of the decoded clouds
  foxglove::SliceStreamInfo about;  // without the frame and the topic

  /// Reads the caps. Returns nothing and sets `why` if they are not the caps of slices that can be
  /// decoded.
  static std::optional<SliceCaps> Parse(const GstCaps* caps, std::string* why);
  /// Returns true if the same decoder can decode the slices of both caps.
  bool HasSameDecoder(const SliceCaps& other) const {
    return about.has_ranges == other.about.has_ranges && about.fields == other.about.fields &&
           about.sensor_model == other.about.sensor_model;
  }
};

}  // namespace lidar::web
