// SPDX-License-Identifier: LGPL-2.1-or-later
// A pipeline that is made from a launch line. The test waits for its end.
#pragma once
#include <gio/gio.h>
#include <gst/gst.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "gst/common/refs.h"
#include "tests/support/element_bus.h"

namespace lidar::test {

using gst::ElementPtr;
using gst::MessagePtr;

/// Returns the port that a source with port=0 has bound, or 0 if the source has no socket.
inline guint PortOf(GstElement* source) {
  GSocket* socket = nullptr;
  g_object_get(source, "used-socket", &socket, nullptr);
  if (socket == nullptr) return 0;
  GSocketAddress* address = g_socket_get_local_address(socket, nullptr);
  const guint port = g_inet_socket_address_get_port(G_INET_SOCKET_ADDRESS(address));
  g_object_unref(address);
  g_object_unref(socket);
  return port;
}

/// The queue of a screamsink for tests in which no packet may be dropped. A busy machine may stop a
/// thread for longer than the default allows packets to wait.
inline const std::string kPatientQueue = "max-queue-delay=5000000000";

class Pipeline {
 public:
  explicit Pipeline(const std::string& text) {
    GError* error = nullptr;
    element_.reset(gst_parse_launch(text.c_str(), &error));
    if (error == nullptr) return;
    ADD_FAILURE() << error->message;
    g_error_free(error);
  }
  ~Pipeline() {
    if (element_) gst_element_set_state(element_.get(), GST_STATE_NULL);
  }
  Pipeline(Pipeline&&) = default;
  void Set(GstState state) { gst_element_set_state(element_.get(), state); }
  void Play() { Set(GST_STATE_PLAYING); }
  ElementPtr Get(const char* name) {
    return ElementPtr(gst_bin_get_by_name(GST_BIN(element_.get()), name));
  }
  void SendEos() { gst_element_send_event(element_.get(), gst_event_new_eos()); }
  MessagePtr Wait(int types) { return ElementBus(element_.get()).Wait(types); }
  ::testing::AssertionResult Ends() {
    const MessagePtr message = Wait(GST_MESSAGE_EOS | GST_MESSAGE_ERROR);
    if (!message) return ::testing::AssertionFailure() << "no EOS";
    if (GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_EOS) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << MessageText(message.get());
  }

 private:
  std::unique_ptr<GstElement, gst::Unref> element_;
};

}  // namespace lidar::test
