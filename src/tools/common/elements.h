// SPDX-License-Identifier: LGPL-2.1-or-later
// Helpers to build pipelines, and to read messages of the bus.
#pragma once
#include <glib-unix.h>
#include <gst/gst.h>

#include <csignal>
#include <cstdio>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "gst/common/refs.h"
#include "src/tools/common/printable.h"

namespace lidar::tools {

/// Makes an element by `factory` and adds it to `bin`. Without `name`, the element gets a unique
/// name. Throws std::runtime_error if the element is not installed.
inline GstElement* AddElement(GstElement* bin, const std::string& factory,
                              const char* name = nullptr) {
  GstElement* element = gst_element_factory_make(factory.c_str(), name);
  if (element == nullptr)
    throw std::runtime_error("the GStreamer element " + factory +
                             " is not installed (is GST_PLUGIN_PATH set?)");
  gst_bin_add(GST_BIN(bin), element);
  return element;
}

/// Makes a pipeline from the words of a command line. Prints an error and returns null if that
/// fails.
inline gst::ElementPtr ParsePipeline(const std::vector<std::string>& words) {
  std::vector<const gchar*> argv;
  for (const std::string& word : words) argv.push_back(word.c_str());
  argv.push_back(nullptr);
  GError* raw = nullptr;
  gst::ElementPtr pipeline(gst_parse_launchv(argv.data(), &raw));
  const gst::ErrorPtr error(raw);
  if (!error && GST_IS_BIN(pipeline.get())) return pipeline;
  std::fprintf(stderr, "%s\n", error ? error->message : "a single element is not a pipeline");
  return nullptr;
}

/// Makes SIGINT and SIGTERM set `*run` to false. This takes effect when the main context is
/// iterated.
inline void StopOnSignals(bool* run) {
  const auto interrupt = [](gpointer data) -> gboolean {
    *static_cast<bool*>(data) = false;
    return G_SOURCE_CONTINUE;
  };
  g_unix_signal_add(SIGINT, interrupt, run);
  g_unix_signal_add(SIGTERM, interrupt, run);
}

/// Sets a property to a text. If `value` is empty, the property keeps its default.
inline void SetText(GstElement* element, const char* property, const std::string& value) {
  if (!value.empty()) g_object_set(element, property, value.c_str(), nullptr);
}

/// Returns the `stats` of an element in `bin`. Returns null if there is no such element, or if it
/// has no `stats`.
inline gst::StructurePtr StatsOf(GstElement* bin, const std::string& element) {
  const gst::ElementPtr found(gst_bin_get_by_name(GST_BIN(bin), element.c_str()));
  GstStructure* raw = nullptr;
  if (found && g_object_class_find_property(G_OBJECT_GET_CLASS(found.get()), "stats") != nullptr)
    g_object_get(found.get(), "stats", &raw, nullptr);
  return gst::StructurePtr(raw);
}

/// Prints a line of statistics for each element in `names`, which is a comma-separated list. Each
/// line begins with `before`.
inline void PrintStats(GstElement* bin, const std::string& names, const std::string& before = "") {
  std::istringstream words(names);
  for (std::string name; std::getline(words, name, ',');) {
    const gst::StructurePtr stats = StatsOf(bin, name);
    if (!stats) continue;
    const gst::StringPtr text(gst_structure_to_string(stats.get()));
    std::printf("%s%s: %s\n", before.c_str(), name.c_str(), text.get());
  }
  std::fflush(stdout);
}

/// Returns the text of an error or a warning.
inline std::string ErrorText(GstMessage* message) {
  GError* raw = nullptr;
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR)
    gst_message_parse_error(message, &raw, nullptr);
  else
    gst_message_parse_warning(message, &raw, nullptr);
  const gst::ErrorPtr error(raw);
  return Printable(error->message);
}

/// Returns the name of the object that posted an error or a warning, and the text of the message.
inline std::string MessageText(GstMessage* message) {
  return Printable(GST_MESSAGE_SRC_NAME(message)) + ": " + ErrorText(message);
}

}  // namespace lidar::tools
