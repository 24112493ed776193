// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/apps/fleet/exposition.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "src/tools/common/elements.h"

namespace lidar::fleet {
namespace {

using nlohmann::json;

json ValueOf(const GValue* v) {
  switch (G_VALUE_TYPE(v)) {
    case G_TYPE_BOOLEAN:
      return g_value_get_boolean(v) != FALSE;
    case G_TYPE_INT:
      return g_value_get_int(v);
    case G_TYPE_UINT:
      return g_value_get_uint(v);
    case G_TYPE_INT64:
      return g_value_get_int64(v);
    case G_TYPE_UINT64:  // the largest value means unset
      if (g_value_get_uint64(v) != G_MAXUINT64) return g_value_get_uint64(v);
      return nullptr;
    case G_TYPE_DOUBLE:
      return g_value_get_double(v);
    case G_TYPE_STRING:
      if (const gchar* text = g_value_get_string(v)) return text;
      return nullptr;
    default:
      return G_VALUE_HOLDS(v, GST_TYPE_STRUCTURE) && gst_value_get_structure(v) != nullptr
                 ? ToJson(gst_value_get_structure(v))
                 : json();
  }
}

std::string MetricName(const std::string& element, const std::string& field) {
  std::string name = "lidar_" + element + "_" + field;
  for (char& c : name)
    if (g_ascii_isalnum(c) == FALSE) c = '_';
  return name;
}

}  // namespace

std::string RobotLabels(const std::string& robot, const std::string& sensor) {
  return "{robot=\"" + robot + "\",sensor=\"" + sensor + "\"}";
}

json ToJson(const GstStructure* structure) {
  json object = json::object();
  for (gint i = 0; i < gst_structure_n_fields(structure); ++i) {
    const gchar* name = gst_structure_nth_field_name(structure, static_cast<guint>(i));
    json value = ValueOf(gst_structure_get_value(structure, name));
    if (!value.is_null()) object[name] = std::move(value);
  }
  return object;
}

void Exposition::Add(const std::string& name, const std::string& labels, double value) {
  if (!std::isfinite(value)) return;
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  lines_[name].push_back(name + labels + " " + std::string(text, end) + "\n");
}

void Exposition::Add(const std::string& element, const std::string& labels,
                     const GstStructure* structure) {
  const json object = ToJson(structure);
  for (const auto& item : object.items()) {
    if (item.value().is_number())
      Add(MetricName(element, item.key()), labels, item.value().get<double>());
    else if (item.value().is_boolean())
      Add(MetricName(element, item.key()), labels, item.value().get<bool>() ? 1 : 0);
  }
}

std::string Exposition::text() const {
  std::string out;
  for (const auto& [name, lines] : lines_) {
    out += "# TYPE " + name + " untyped\n";
    for (const std::string& line : lines) out += line;
  }
  return out;
}

void AddStats(GstElement* bin, const std::vector<std::string>& elements, const std::string& labels,
              Exposition* exposition, json* report) {
  for (const std::string& element : elements) {
    const gst::StructurePtr stats = tools::StatsOf(bin, element);
    if (!stats) continue;
    (*report)[element] = ToJson(stats.get());
    exposition->Add(element, labels, stats.get());
  }
}

std::string ToText(const json& report) {
  return report.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace lidar::fleet
