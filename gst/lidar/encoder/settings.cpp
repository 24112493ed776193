// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/lidar/encoder/settings.h"

#include "gst/common/enum_type.h"
#include "gst/common/refs.h"

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

std::unique_ptr<rate::SizeModel> LoadModel(GstElement* element, const EncoderSettings& s) {
  const auto kind = s.rate_model;
  if (s.model_location.empty()) return rate::MakeBuiltInModel(kind);
  gchar* text = nullptr;
  gsize size = 0;
  GError* failure = nullptr;
  if (!g_file_get_contents(s.model_location.c_str(), &text, &size, &failure)) {
    const ErrorPtr owned(failure);
    GST_ELEMENT_ERROR(element, RESOURCE, OPEN_READ,
                      ("Cannot read the rate model \"%s\".", s.model_location.c_str()),
                      ("%s", failure->message));
    return nullptr;
  }
  const StringPtr owned(text);
  std::string error;
  std::unique_ptr<rate::SizeModel> model;
  if (const auto file = rate::ParseModelFile({text, size}, &error))
    model = rate::MakeModel(*file, kind, &error);
  if (!model) {
    GST_ELEMENT_ERROR(element, RESOURCE, READ,
                      ("The rate model \"%s\" cannot be used.", s.model_location.c_str()),
                      ("%s", error.c_str()));
  }
  return model;
}

}  // namespace lidar::gst
