// SPDX-License-Identifier: LGPL-2.1-or-later
// Functions that make an ecnudpsink or an ecnudpsrc in a harness.
#pragma once
#include <gio/gio.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"
#include "tests/support/element_stats.h"
#include "tests/support/harness.h"

namespace lidar::gst {

struct ObjectFree {
  void operator()(gpointer p) const { g_object_unref(p); }
};
template <class T>
using Object = std::unique_ptr<T, ObjectFree>;

template <class T>
Object<T> GetObject(GstHarness* h, const char* property) {
  T* value = nullptr;
  g_object_get(h->element, property, &value, nullptr);
  return Object<T>(value);
}

inline guint LocalPort(GstHarness* h) {
  const auto socket = GetObject<GSocket>(h, "used-socket");
  if (!socket) return 0;
  const Object<GSocketAddress> address(g_socket_get_local_address(socket.get(), nullptr));
  return g_inet_socket_address_get_port(G_INET_SOCKET_ADDRESS(address.get()));
}

inline guint64 Stat(GstHarness* h, const char* field) { return test::StatOf(h->element, field); }

inline GstBuffer* Payload(const std::string& text) {
  GstBuffer* buffer = gst_buffer_new_allocate(nullptr, text.size(), nullptr);
  gst_buffer_fill(buffer, 0, text.data(), text.size());
  return buffer;
}

inline std::string Text(GstBuffer* buffer) {
  std::string text(gst_buffer_get_size(buffer), '\0');
  gst_buffer_extract(buffer, 0, text.data(), text.size());
  return text;
}

/// Returns a sink that is not started yet, because properties may have to be set before a harness
/// starts it.
inline GstElement* SinkElement() {
  GstElement* sink = gst_element_factory_make("ecnudpsink", nullptr);
  g_object_set(sink, "sync", FALSE, "async", FALSE, nullptr);
  return sink;
}

inline test::Harness Wrap(GstElement* sink) {
  test::Harness harness(gst_harness_new_with_element(sink, "sink", nullptr));
  gst_object_unref(sink);
  gst_harness_set_src_caps_str(harness.get(), "application/x-rtp");
  return harness;
}

inline test::Harness NewSink(const char* host, guint port) {
  GstElement* sink = SinkElement();
  g_object_set(sink, "host", host, "port", port, nullptr);
  return Wrap(sink);
}

inline test::Harness NewSource(const char* address = nullptr) {
  test::Harness src(gst_harness_new_with_padnames("ecnudpsrc", nullptr, "src"));
  g_object_set(src->element, "port", 0, "address", address, nullptr);
  test::SetPlaying(src.get());
  return src;
}

}  // namespace lidar::gst
