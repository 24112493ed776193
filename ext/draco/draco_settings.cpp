// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/draco/draco_settings.h"

namespace lidar::gst {
namespace {

using codec::RangeCoder;

template <class E>
constexpr gint Int(E value) {
  return static_cast<gint>(value);
}

const GEnumValue kGeometries[] = {
    {Int(GeometryChoice::kAuto), "range where the caps carry ranges and a sensor model", "auto"},
    {Int(GeometryChoice::kXyz), "Plain Draco files", "xyz"},
    {Int(GeometryChoice::kRange), "Ranges of an organised scan", "range"},
    {0, nullptr, nullptr}};
const GEnumValue kCoders[] = {
    {Int(RangeCoder::kDraco), "Draco, with its own delta prediction", "draco"},
    {Int(RangeCoder::kResidual), "Prediction from neighbouring beams, then Draco", "residual"},
    {0, nullptr, nullptr}};

GType Register(const char* name, const GEnumValue* values) {
  const GType type = g_enum_register_static(name, values);
  gst_type_mark_as_plugin_api(type, static_cast<GstPluginAPIFlags>(0));
  return type;
}

}  // namespace

GType DracoGeometryType() {
  static const GType type = Register("GstLidarDracoEncGeometry", kGeometries);
  return type;
}

GType DracoRangeCoderType() {
  static const GType type = Register("GstLidarDracoEncRangeCoder", kCoders);
  return type;
}

}  // namespace lidar::gst
