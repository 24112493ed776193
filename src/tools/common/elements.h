// SPDX-License-Identifier: LGPL-2.1-or-later
// Elements that programs put together, and what they say on the bus.
#pragma once
#include <gst/gst.h>

#include <stdexcept>
#include <string>

#include "gst/common/refs.h"
#include "src/tools/common/printable.h"

namespace lidar::tools {

/// Makes an element of `factory` in `bin`; without a name it gets one of its own. Throws
/// std::runtime_error where it is not installed.
inline GstElement* AddElement(GstElement* bin, const std::string& factory,
                              const char* name = nullptr) {
  GstElement* element = gst_element_factory_make(factory.c_str(), name);
  if (element == nullptr)
    throw std::runtime_error("the GStreamer element " + factory +
                             " is not installed (is GST_PLUGIN_PATH set?)");
  gst_bin_add(GST_BIN(bin), element);
  return element;
}

/// An empty text leaves the default.
inline void SetText(GstElement* element, const char* property, const std::string& value) {
  if (!value.empty()) g_object_set(element, property, value.c_str(), nullptr);
}

/// What an error or a warning says, after who says it.
inline std::string MessageText(GstMessage* message) {
  GError* raw = nullptr;
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR)
    gst_message_parse_error(message, &raw, nullptr);
  else
    gst_message_parse_warning(message, &raw, nullptr);
  const gst::ErrorPtr error(raw);
  return Printable(std::string(GST_MESSAGE_SRC_NAME(message)) + ": " + error->message);
}

}  // namespace lidar::tools
