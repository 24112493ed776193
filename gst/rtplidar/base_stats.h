// SPDX-License-Identifier: LGPL-2.1-or-later
// Extends the property `stats` that GStreamer's RTP base classes already have.
#pragma once
#include "gst/common/refs.h"

namespace lidar::gst {

/// Returns the value of `stats` that `object` inherits from `parent_class` or an ancestor of it.
/// The element adds its own fields to this value.
inline StructurePtr BaseClassStats(GObject* object, gpointer parent_class) {
  GParamSpec* spec = g_object_class_find_property(G_OBJECT_CLASS(parent_class), "stats");
  GValue value = G_VALUE_INIT;
  g_value_init(&value, GST_TYPE_STRUCTURE);
  G_OBJECT_CLASS(g_type_class_peek(spec->owner_type))
      ->get_property(object, spec->param_id, &value, spec);
  StructurePtr stats(static_cast<GstStructure*>(g_value_dup_boxed(&value)));
  g_value_unset(&value);
  return stats;
}

}  // namespace lidar::gst
