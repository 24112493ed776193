// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/lidarcodec/lidarenc_settings.h"

#include "gst/common/enum_type.h"

namespace lidar::gst {
namespace {

GType EffortType() {
  static const GEnumValue values[] = {
      {LidarEncSettings::kAutoEffort, "The highest that codes a slice in a quarter of its sweep",
       "auto"},
      {0, "Fastest: adaptive rANS", "0"},
      {1, "Mixed contexts, few", "1"},
      {2, "Mixed contexts, more", "2"},
      {3, "Smallest: mixed contexts, all", "3"},
      {0, nullptr, nullptr}};
  static const GType type = RegisterEnum("GstLidarEncEffort", values);
  return type;
}

GType ReferenceType() {
  static const GEnumValue values[] = {
      {Int(Reference::kNothing), "Every slice stands alone", "none"},
      {Int(Reference::kAcknowledged),
       "The newest scan that the receiver has, where the sensor stands still", "auto"},
      {0, nullptr, nullptr}};
  static const GType type = RegisterEnum("GstLidarEncReference", values);
  return type;
}

}  // namespace

const std::array<Property<LidarEncSettings>, 3>& LidarEncRows() {
  static const std::array<Property<LidarEncSettings>, 3> rows = {{
      {"effort", "How much computing slices are worth",
       EnumField<LidarEncSettings>{&LidarEncSettings::effort, EffortType}, 0, 0,
       GST_PARAM_MUTABLE_PLAYING},
      {"reference",
       "What slices may be predicted from; what nobody acknowledges is predicted from nothing",
       EnumField<LidarEncSettings, Reference>{&LidarEncSettings::reference, ReferenceType}, 0, 0,
       GST_PARAM_MUTABLE_PLAYING},
      {"key-interval",
       "Each sector comes at least so often as a slice that stands alone, for those who join late; "
       "0: only when asked for [ns]",
       &LidarEncSettings::key_interval, 0, 3600e9, GST_PARAM_MUTABLE_PLAYING},
  }};
  return rows;
}

}  // namespace lidar::gst
