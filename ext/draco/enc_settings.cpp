// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/draco/enc_settings.h"

namespace lidar::gst {
namespace {

using codec::RangeCoder;
using rate::DegradationPreference;
using rate::RateModel;
using Settings = EncSettings;

const GEnumValue kGeometries[] = {
    {Int(GeometryChoice::kAuto), "range where the caps carry ranges and a sensor model", "auto"},
    {Int(GeometryChoice::kXyz), "Plain Draco files", "xyz"},
    {Int(GeometryChoice::kRange), "Ranges of an organised scan", "range"},
    {0, nullptr, nullptr}};
const GEnumValue kCoders[] = {
    {Int(RangeCoder::kDraco), "Draco, with its own delta prediction", "draco"},
    {Int(RangeCoder::kResidual), "Prediction from neighbouring beams, then Draco", "residual"},
    {Int(RangeCoder::kAdaptive), "Prediction from neighbouring beams, then adaptive rANS",
     "adaptive"},
    {0, nullptr, nullptr}};
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

GType RegisterEnum(gsize* type, const char* name, const GEnumValue* values) {
  if (g_once_init_enter(type)) {
    const GType registered = g_enum_register_static(name, values);
    gst_type_mark_as_plugin_api(registered, static_cast<GstPluginAPIFlags>(0));
    g_once_init_leave(type, registered);
  }
  return *type;
}
GType GeometryType() {
  static gsize type = 0;
  return RegisterEnum(&type, "GstLidarDracoEncGeometry", kGeometries);
}
GType CoderType() {
  static gsize type = 0;
  return RegisterEnum(&type, "GstLidarDracoEncRangeCoder", kCoders);
}
GType RateModelType() {
  static gsize type = 0;
  return RegisterEnum(&type, "GstLidarDracoEncRateModel", kRateModels);
}
GType PreferenceType() {
  static gsize type = 0;
  return RegisterEnum(&type, "GstLidarDracoEncDegradationPreference", kPreferences);
}

}  // namespace

const std::array<Property<EncSettings>, kEncPropertyCount>& EncProperties() {
  static const std::array<Property<EncSettings>, kEncPropertyCount> table = {{
      {"bitrate",
       "Bitrate of the encoded slices [bit/s]; 0: constant quality at the coarsest step that "
       "max-error allows. An event target-bitrate goes before it",
       &Settings::bitrate_bps, 0, G_MAXUINT, GST_PARAM_MUTABLE_PLAYING},
      {"max-error", "Largest distance between a point and its decoded point [m]",
       &Settings::max_error_m, 1e-4, 100, GST_PARAM_MUTABLE_PLAYING},
      {"geometry", "What is coded: ranges or coordinates",
       EnumField<Settings>{&Settings::geometry, GeometryType}},
      {"range-coder", "How ranges are coded",
       EnumField<Settings>{&Settings::range_coder, CoderType}},
      {"quantization-step",
       "Fixes the step of the grid [m], whatever the bitrate; max-error still holds. 0: automatic",
       &Settings::step_m, 0, 1000, GST_PARAM_MUTABLE_PLAYING},
      {"compression-level",
       "Draco's compression level for xyz geometry: 0 is its sequential coder, 1-10 its kd-tree",
       &Settings::level, 0, 10, GST_PARAM_MUTABLE_PLAYING},
      {"intensity-bits", "Resolution of intensities [bit]; 0: geometry only",
       &Settings::intensity_bits, 0, 8},
      {"rate-model", "Predicts the size of a slice",
       EnumField<Settings>{&Settings::rate_model, RateModelType}},
      {"model-location", "File with the coefficients of the rate model; none: built-in",
       &Settings::model_location},
      {"degradation-preference", "What gives when the bitrate is below what max-error needs",
       EnumField<Settings>{&Settings::degradation, PreferenceType}, 0, 0,
       GST_PARAM_MUTABLE_PLAYING},
      {"threads",
       "Threads for one buffer in range geometry, while each has 8,000 returns to code: more are "
       "faster, and a little larger",
       &Settings::threads, 1, 64},
      {"error-check",
       "Decodes every n-th slice again and posts its real point errors as the element message "
       "dracoenc-error-check; 0: none",
       &Settings::error_check, 0, G_MAXUINT, GST_PARAM_MUTABLE_PLAYING},
  }};
  return table;
}

std::optional<Geometry> GeometryOf(gint choice) {
  if (choice == Int(GeometryChoice::kAuto)) return std::nullopt;
  return choice == Int(GeometryChoice::kXyz) ? Geometry::kXyz : Geometry::kRange;
}

const char* GeometryName(gint geometry) { return kGeometries[geometry].value_nick; }

}  // namespace lidar::gst
