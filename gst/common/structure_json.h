// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts the statistics of elements to JSON.
#pragma once
#include <gst/gst.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "gst/common/refs.h"

namespace lidar::gst {

enum class FieldNames {
  kAsTheyAre,
  kWithoutDashes,  // needed for the paths in Foxglove's plots
};

inline nlohmann::json ToJson(const GstStructure* structure, FieldNames names);

inline nlohmann::json ToJson(const GValue* value, FieldNames names) {
  const auto items = [&](guint count, const GValue* (*get)(const GValue*, guint)) {
    auto array = nlohmann::json::array();
    for (guint i = 0; i < count; ++i) array.push_back(ToJson(get(value, i), names));
    return array;
  };
  if (GST_VALUE_HOLDS_STRUCTURE(value)) return ToJson(gst_value_get_structure(value), names);
  if (GST_VALUE_HOLDS_ARRAY(value))
    return items(gst_value_array_get_size(value), gst_value_array_get_value);
  if (GST_VALUE_HOLDS_LIST(value))
    return items(gst_value_list_get_size(value), gst_value_list_get_value);
  if (G_VALUE_HOLDS_INT(value)) return g_value_get_int(value);
  if (G_VALUE_HOLDS_UINT(value)) return g_value_get_uint(value);
  if (G_VALUE_HOLDS_INT64(value)) return g_value_get_int64(value);
  if (G_VALUE_HOLDS_UINT64(value)) return g_value_get_uint64(value);
  if (G_VALUE_HOLDS_DOUBLE(value)) return g_value_get_double(value);
  if (G_VALUE_HOLDS_BOOLEAN(value)) return g_value_get_boolean(value) != FALSE;
  if (G_VALUE_HOLDS_STRING(value)) {
    const gchar* text = g_value_get_string(value);
    return text != nullptr ? text : "";
  }
  const StringPtr text(gst_value_serialize(value));
  return text ? text.get() : "";
}

/// Converts numbers, booleans, strings, arrays and structures. Other types are converted to
/// GStreamer's text; the text of an enumeration is its nick. NULL is converted to an empty object.
inline nlohmann::json ToJson(const GstStructure* structure, FieldNames names) {
  auto object = nlohmann::json::object();
  if (structure == nullptr) return object;
  for (gint i = 0; i < gst_structure_n_fields(structure); ++i) {
    std::string name = gst_structure_nth_field_name(structure, static_cast<guint>(i));
    const GValue* value = gst_structure_get_value(structure, name.c_str());
    if (names == FieldNames::kWithoutDashes) std::replace(name.begin(), name.end(), '-', '_');
    object[name] = ToJson(value, names);
  }
  return object;
}

/// Returns the property `stats` of an element as JSON, or null if the element has none.
inline nlohmann::json StatsAsJson(GstElement* element, FieldNames names) {
  if (element == nullptr) return nullptr;
  GParamSpec* spec = g_object_class_find_property(G_OBJECT_GET_CLASS(element), "stats");
  if (spec == nullptr || spec->value_type != GST_TYPE_STRUCTURE ||
      (spec->flags & G_PARAM_READABLE) == 0)
    return nullptr;
  GstStructure* stats = nullptr;
  g_object_get(element, "stats", &stats, nullptr);
  const StructurePtr owner(stats);
  return stats != nullptr ? ToJson(stats, names) : nlohmann::json(nullptr);
}

}  // namespace lidar::gst
