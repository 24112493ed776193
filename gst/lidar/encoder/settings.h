// SPDX-License-Identifier: LGPL-2.1-or-later
// The settings that all encoders have.
#pragma once
#include <gst/gst.h>

#include <memory>
#include <string>

#include "src/rate/model_file.h"
#include "src/rate/scan_plan.h"
#include "src/rate/size_model.h"

namespace lidar::gst {

struct EncoderSettings {
  guint bitrate_bps = 0;
  gdouble max_error_m = 0.02;
  gdouble step_m = 0;
  guint intensity_bits = 5;
  rate::RateModel rate_model = rate::RateModel::kAdaptive;
  std::string model_location;
  rate::DegradationPreference degradation = rate::DegradationPreference::kMaintainAccuracy;
  guint threads = 1;
  guint error_check = 0;
  Duration stats_interval{};
};

GType RateModelType();
GType DegradationPreferenceType();

/// Returns the rate model that the settings select. If the file of the model cannot be read or
/// used, posts an error message of `element` and returns null.
std::unique_ptr<rate::SizeModel> LoadModel(GstElement* element, const EncoderSettings& settings);

}  // namespace lidar::gst
