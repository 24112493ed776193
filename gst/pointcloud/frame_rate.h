// SPDX-License-Identifier: LGPL-2.1-or-later
// Clouds per second, as caps and a property have them.
#pragma once
#include "gst/common/fields.h"

namespace lidar::gst {

struct FrameRate {
  gint n = 0;  // 0: not known
  gint d = 1;
};
template <>
struct Kind<FrameRate> {
  static GType Type() { return GST_TYPE_FRACTION; }
  static GParamSpec* Spec(const SpecArgs& a, FrameRate initial) {
    return gst_param_spec_fraction(a.name, a.name, a.blurb, 0, 1, G_MAXINT, 1, initial.n, initial.d,
                                   a.flags);
  }
  static void Set(FrameRate* field, const GValue* v) {
    *field = {gst_value_get_fraction_numerator(v), gst_value_get_fraction_denominator(v)};
  }
  static void Get(FrameRate value, GValue* v) { gst_value_set_fraction(v, value.n, value.d); }
};

}  // namespace lidar::gst
