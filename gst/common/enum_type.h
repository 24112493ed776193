// SPDX-License-Identifier: LGPL-2.1-or-later
// The GTypes of enumerations that are properties.
#pragma once
#include <gst/gst.h>

namespace lidar::gst {

/// A value of an enumeration, as GObject keeps it.
template <class E>
constexpr gint Int(E value) {
  return static_cast<gint>(value);
}

/// Registers an enumeration with a new name, and documents it with the plugin. `values` have static
/// storage and end with an empty row.
inline GType RegisterEnum(const char* name, const GEnumValue* values) {
  const GType type = g_enum_register_static(name, values);
  gst_type_mark_as_plugin_api(type, static_cast<GstPluginAPIFlags>(0));
  return type;
}

}  // namespace lidar::gst
