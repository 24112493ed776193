// SPDX-License-Identifier: LGPL-2.1-or-later
// Registers the GTypes of enumerations that are used as properties.
#pragma once
#include <gst/gst.h>

namespace lidar::gst {

/// Converts a value of an enumeration to the integer that GObject stores.
template <class E>
constexpr gint Int(E value) {
  return static_cast<gint>(value);
}

/// Registers an enumeration under a new name, and adds it to the documentation of the plugin.
/// `values` must have static storage and end with an empty row.
inline GType RegisterEnum(const char* name, const GEnumValue* values) {
  const GType type = g_enum_register_static(name, values);
  gst_type_mark_as_plugin_api(type, static_cast<GstPluginAPIFlags>(0));
  return type;
}

}  // namespace lidar::gst
