// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/common/encoder/settings.h"

#include "gst/common/enum_type.h"

namespace lidar::gst {
namespace {

using rate::DegradationPreference;
using rate::RateModel;

const GEnumValue kRateModels[] = {
    {Int(RateModel::kAdaptive), "Log size against log step, corrected by every slice", "adaptive"},
    {Int(RateModel::kPaper), "Second-order polynomial of the paper, fixed", "paper"},
    {0, nullptr, nullptr}};
const GEnumValue kPreferences[] = {
    {Int(DegradationPreference::kMaintainAccuracy), "Skip whole scans, evenly",
     "maintain-accuracy"},
    {Int(DegradationPreference::kMaintainFramerate), "Thin the points of every scan, evenly",
     "maintain-framerate"},
    {Int(DegradationPreference::kBalanced), "Both by the same factor", "balanced"},
    {0, nullptr, nullptr}};

}  // namespace

GType RateModelType() {
  static const GType type = RegisterEnum("GstLidarRateModel", kRateModels);
  return type;
}

GType DegradationPreferenceType() {
  static const GType type = RegisterEnum("GstLidarDegradationPreference", kPreferences);
  return type;
}

}  // namespace lidar::gst
