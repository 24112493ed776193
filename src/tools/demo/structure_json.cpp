// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/demo/structure_json.h"

#include "gst/common/refs.h"

namespace lidar::demo {
namespace {

nlohmann::json ToJson(const GValue* value);

nlohmann::json Items(const GValue* value, guint count, const GValue* (*get)(const GValue*, guint)) {
  auto items = nlohmann::json::array();
  for (guint i = 0; i < count; ++i) items.push_back(ToJson(get(value, i)));
  return items;
}

nlohmann::json Integer(const GValue* value) {
  switch (G_VALUE_TYPE(value)) {
    case G_TYPE_INT:
      return g_value_get_int(value);
    case G_TYPE_UINT:
      return g_value_get_uint(value);
    case G_TYPE_INT64:
      return g_value_get_int64(value);
    case G_TYPE_UINT64:
      return g_value_get_uint64(value);
    default:
      return nullptr;
  }
}

nlohmann::json ToJson(const GValue* value) {
  if (auto integer = Integer(value); !integer.is_null()) return integer;
  if (G_VALUE_HOLDS_DOUBLE(value)) return g_value_get_double(value);
  if (G_VALUE_HOLDS_BOOLEAN(value)) return g_value_get_boolean(value) != FALSE;
  if (G_VALUE_HOLDS_STRING(value)) {
    const gchar* text = g_value_get_string(value);
    return text != nullptr ? text : "";
  }
  if (GST_VALUE_HOLDS_STRUCTURE(value)) return demo::ToJson(gst_value_get_structure(value));
  if (GST_VALUE_HOLDS_ARRAY(value))
    return Items(value, gst_value_array_get_size(value), gst_value_array_get_value);
  if (GST_VALUE_HOLDS_LIST(value))
    return Items(value, gst_value_list_get_size(value), gst_value_list_get_value);
  const gst::StringPtr text(gst_value_serialize(value));
  return text ? text.get() : "";
}

}  // namespace

nlohmann::json ToJson(const GstStructure* structure) {
  auto object = nlohmann::json::object();
  if (structure == nullptr) return object;
  gst_structure_foreach(
      structure,
      [](GQuark field, const GValue* value, gpointer out) -> gboolean {
        (*static_cast<nlohmann::json*>(out))[g_quark_to_string(field)] = ToJson(value);
        return TRUE;
      },
      &object);
  return object;
}

nlohmann::json StatsOf(GstElement* element) {
  if (element == nullptr ||
      g_object_class_find_property(G_OBJECT_GET_CLASS(element), "stats") == nullptr)
    return nullptr;
  GstStructure* stats = nullptr;
  g_object_get(element, "stats", &stats, nullptr);
  const gst::StructurePtr owner(stats);
  return stats != nullptr ? ToJson(stats) : nlohmann::json(nullptr);
}

}  // namespace lidar::demo
