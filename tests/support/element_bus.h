// SPDX-License-Identifier: LGPL-2.1-or-later
// The messages that an element posts.
#pragma once
#include <gst/gst.h>

#include <memory>
#include <string>
#include <vector>

#include "gst/common/refs.h"
#include "tests/support/patience.h"

namespace lidar::test {

/// Returns the text of an error or a warning.
inline std::string MessageText(GstMessage* message) {
  GError* error = nullptr;
  GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR
      ? gst_message_parse_error(message, &error, nullptr)
      : gst_message_parse_warning(message, &error, nullptr);
  return gst::ErrorPtr(error)->message;
}

/// Returns the details of an error or a warning.
inline std::string MessageDetails(GstMessage* message) {
  gchar* details = nullptr;
  GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR
      ? gst_message_parse_error(message, nullptr, &details)
      : gst_message_parse_warning(message, nullptr, &details);
  const gst::StringPtr owner(details);
  return details != nullptr ? details : "";
}

/// Reads messages from the bus of an element. Gives the element a bus if it has none.
class ElementBus {
 public:
  explicit ElementBus(GstElement* element) : bus_(gst_element_get_bus(element)) {
    if (bus_) return;
    bus_.reset(gst_bus_new());
    gst_element_set_bus(element, bus_.get());
    own_.reset(GST_ELEMENT(gst_object_ref(element)));
  }

  /// Returns the next message of `types`, or null if there is none. Drops the messages of other
  /// types before it.
  gst::MessagePtr Pop(int types = GST_MESSAGE_ANY) const { return Wait(types, 0); }
  gst::MessagePtr Wait(int types = GST_MESSAGE_ANY, GstClockTime timeout = kPatience_ns) const {
    return gst::MessagePtr(
        gst_bus_timed_pop_filtered(bus_.get(), timeout, static_cast<GstMessageType>(types)));
  }
  /// Returns the text of the next error or warning of `types`, or an empty text if there is none.
  std::string Text(int types) const {
    const gst::MessagePtr message = Pop(types);
    return message ? MessageText(message.get()) : "";
  }
  /// Returns the texts of all messages of `type`, which must be a type of errors or warnings.
  std::vector<std::string> Texts(GstMessageType type) const {
    std::vector<std::string> texts;
    while (const gst::MessagePtr message = Pop(type)) texts.push_back(MessageText(message.get()));
    return texts;
  }

 private:
  struct TakeBus {
    void operator()(GstElement* element) const {
      gst_element_set_bus(element, nullptr);
      gst_object_unref(element);
    }
  };
  std::unique_ptr<GstBus, gst::Unref> bus_;
  std::unique_ptr<GstElement, TakeBus> own_;  // null if the element had a bus
};

}  // namespace lidar::test
