// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/web/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "gst/common/structure_json.h"

namespace lidar::web {
namespace {

using gst::ElementPtr;
using gst::StringPtr;
using nlohmann::json;

ElementPtr TopOf(GstElement* element) {
  ElementPtr top(GST_ELEMENT(gst_object_ref(element)));
  while (GstObject* parent = gst_object_get_parent(GST_OBJECT(top.get()))) {
    if (!GST_IS_ELEMENT(parent)) {
      gst_object_unref(parent);
      break;
    }
    top.reset(GST_ELEMENT(parent));
  }
  return top;
}

void Collect(GstElement* element, json* all);

void CollectChildren(GstBin* bin, json* all) {
  GstIterator* children = gst_bin_iterate_elements(bin);
  // If children are added or removed during the iteration, some are missing in this message.
  gst_iterator_foreach(
      children,
      [](const GValue* child, gpointer out) {
        Collect(GST_ELEMENT(g_value_get_object(child)), static_cast<json*>(out));
      },
      all);
  gst_iterator_free(children);
}

void Collect(GstElement* element, json* all) {
  json object = gst::StatsAsJson(element, gst::FieldNames::kWithoutDashes);
  if (!object.is_null()) {
    const StringPtr name(gst_element_get_name(element));
    if (GstElementFactory* factory = gst_element_get_factory(element))
      object["factory"] = GST_OBJECT_NAME(factory);
    (*all)[name.get()] = std::move(object);
  } else if (GST_IS_BIN(element)) {
    CollectChildren(GST_BIN(element), all);
  }
}

/// A member of the message. Its value is the statistic `from` of an element that also has the
/// statistic `beside`.
struct Summary {
  const char* name;
  const char* from;
  const char* beside;
  double scale = 1;      // factor for a number
  std::size_t size = 0;  // length of an array; 0: a number
};
constexpr double kMs = 1e-6;  // from ns
// The first rows use the reports of a sender in another pipeline. The rows after them replace these
// values by values of a sender in this pipeline.
constexpr std::array<Summary, 23> kSummaries = {{
    {"target_bitrate", "sender_target_bitrate", "sender_reports"},
    {"sent_bitrate", "sender_sent_bitrate", "sender_reports"},
    {"estimated_capacity", "sender_estimated_capacity", "sender_reports"},
    {"queue_delay", "sender_queue_delay", "sender_reports", kMs},
    {"rtt", "sender_rtt", "sender_reports", kMs},
    {"ref_wnd", "sender_ref_wnd", "sender_reports"},
    {"bytes_in_flight", "sender_bytes_in_flight", "sender_reports"},
    {"target_bitrate", "target_bitrate", "ref_wnd"},
    {"sent_bitrate", "sent_bitrate", "ref_wnd"},
    {"estimated_capacity", "estimated_capacity", "ref_wnd"},
    {"queue_delay", "queue_delay", "ref_wnd", kMs},
    {"rtt", "rtt", "ref_wnd", kMs},
    {"ref_wnd", "ref_wnd", "ref_wnd"},
    {"bytes_in_flight", "bytes_in_flight", "ref_wnd"},
    {"step", "step", "error_bound"},
    {"error_bound", "error_bound", "error_bound"},
    {"packets_lost", "packets_lost", "packets_ce"},
    {"packets_ce", "packets_ce", "packets_ce"},
    {"slices_lost", "slices_lost", "slices_lost"},
    {"position_deviation", "position_deviation", "position_deviation"},
    {"pose_covariance", "covariance", "scans_degenerate", 1, 36},
    {"poses_degenerate", "scans_degenerate", "scans_degenerate"},
    {"poses_lost", "scans_lost", "scans_degenerate"},
}};

bool IsSenders(const Summary& summary) {
  return std::string_view(summary.beside) == "sender_reports";
}

bool IsFinite(const json& value) { return value.is_number() && std::isfinite(value.get<double>()); }

bool Fits(const Summary& summary, const json& value) {
  if (summary.size == 0) return IsFinite(value);
  return value.is_array() && value.size() == summary.size &&
         std::all_of(value.begin(), value.end(), IsFinite);
}

void AddSummaries(const json& elements, json* message) {
  for (const Summary& summary : kSummaries) {
    for (const json& element : elements) {
      const auto value = element.find(summary.from);
      const auto beside = element.find(summary.beside);
      if (beside == element.end() || value == element.end()) continue;
      if (!Fits(summary, *value)) continue;
      if (IsSenders(summary) && *beside == 0) continue;  // no report yet
      if (summary.scale < 1)
        (*message)[summary.name] = value->get<double>() * summary.scale;
      else
        (*message)[summary.name] = *value;
      break;
    }
  }
}

}  // namespace

std::string StatisticsOf(GstElement* element) {
  const gint64 now_us = g_get_real_time();
  json message = {
      {"timestamp", {{"sec", now_us / G_USEC_PER_SEC}, {"nsec", now_us % G_USEC_PER_SEC * 1000}}}};
  json elements = json::object();
  Collect(TopOf(element).get(), &elements);
  AddSummaries(elements, &message);
  message["elements"] = std::move(elements);
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace lidar::web
