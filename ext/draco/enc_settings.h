// SPDX-License-Identifier: LGPL-2.1-or-later
// The settable properties of dracoenc.
#pragma once
#include <gst/gst.h>

#include <array>
#include <optional>
#include <string>

#include "gst/common/properties.h"
#include "src/cloud/geometry.h"
#include "src/codec/range_header.h"
#include "src/rate/model_file.h"
#include "src/rate/scan_plan.h"

namespace lidar::gst {

/// Enumerations are kept as GObject wants them: by their number.
template <class E>
constexpr gint Int(E value) {
  return static_cast<gint>(value);
}

enum class GeometryChoice { kAuto, kXyz, kRange };

struct EncSettings {
  guint bitrate_bps = 0;
  gdouble max_error_m = 0.02;
  gint geometry = Int(GeometryChoice::kAuto);
  gint range_coder = Int(codec::RangeCoder::kAdaptive);
  gdouble step_m = 0;
  guint level = 7;
  guint intensity_bits = 5;
  gint rate_model = Int(rate::RateModel::kAdaptive);
  std::string model_location;
  gint degradation = Int(rate::DegradationPreference::kMaintainAccuracy);
  guint threads = 1;
  guint error_check = 0;
};

constexpr std::size_t kEncPropertyCount = 12;
const std::array<Property<EncSettings>, kEncPropertyCount>& EncProperties();

/// None for kAuto.
std::optional<Geometry> GeometryOf(gint choice);
/// The value's name in the property `geometry`.
const char* GeometryName(gint geometry);

}  // namespace lidar::gst
