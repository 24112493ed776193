// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/common/encoder/settings.h"

namespace lidar::gst {
namespace {

template <class E>
constexpr gint Int(E value) {
  return static_cast<gint>(value);
}

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

GType Register(const char* name, const GEnumValue* values) {
  const GType type = g_enum_register_static(name, values);
  gst_type_mark_as_plugin_api(type, static_cast<GstPluginAPIFlags>(0));
  return type;
}

}  // namespace

GType RateModelType() {
  static const GType type = Register("GstLidarRateModel", kRateModels);
  return type;
}

GType DegradationPreferenceType() {
  static const GType type = Register("GstLidarDegradationPreference", kPreferences);
  return type;
}

}  // namespace lidar::gst
