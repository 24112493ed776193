// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/draco/draco_settings.h"

#include "gst/common/enum_type.h"

namespace lidar::gst {
namespace {

using codec::RangeCoder;

const GEnumValue kGeometries[] = {
    {Int(GeometryChoice::kAuto), "range where the caps carry ranges and a sensor model", "auto"},
    {Int(GeometryChoice::kXyz), "Plain Draco files", "xyz"},
    {Int(GeometryChoice::kRange), "Ranges of an organised scan", "range"},
    {0, nullptr, nullptr}};
const GEnumValue kCoders[] = {
    {Int(RangeCoder::kDraco), "Draco, with its own delta prediction", "draco"},
    {Int(RangeCoder::kResidual), "Prediction from neighbouring beams, then Draco", "residual"},
    {0, nullptr, nullptr}};

}  // namespace

GType DracoGeometryType() {
  static const GType type = RegisterEnum("GstLidarDracoEncGeometry", kGeometries);
  return type;
}

GType DracoRangeCoderType() {
  static const GType type = RegisterEnum("GstLidarDracoEncRangeCoder", kCoders);
  return type;
}

}  // namespace lidar::gst
