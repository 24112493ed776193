// SPDX-License-Identifier: LGPL-2.1-or-later
// Functions for the tests of ouster_src: captures, pipelines that run to their end, and a UDP
// sender.
#pragma once
#include <gio/gio.h>
#include <gst/gst.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "gst/common/buffer_map.h"
#include "gst/common/refs.h"
#include "gst/lidar/cloud_info.h"
#include "gst/lidar/gstlidar.h"
#include "tests/core/ouster/captures.h"
#include "tests/support/element_bus.h"
#include "tests/support/free_ports.h"
#include "tests/support/harness.h"
#include "tests/support/patience.h"

namespace lidar::test {

// A capture with three scans.
inline constexpr const char* kThreeScans = "OS-1-128_v2.3.0_1024x10_lb_n3.pcap";
inline constexpr const char* kThreeScansMetadata = "OS-1-128_v2.3.0_1024x10.json";

/// Returns the capture times of the datagrams of a file, in order.
inline std::vector<Time> TimesOf(const std::string& name) {
  std::string error;
  auto reader = ouster::PcapReader::Open(DataPath(name), &error);
  EXPECT_TRUE(reader) << error;
  std::vector<Time> times;
  while (auto captured = reader->Next()) times.push_back(captured->time);
  std::sort(times.begin(), times.end());
  return times;
}

/// Sends datagrams to a port of this machine.
class UdpSender {
 public:
  /// Opens the socket. If `from` is empty, the kernel chooses the source address.
  explicit UdpSender(guint16 port, const char* from = "")
      : socket_(g_socket_new(G_SOCKET_FAMILY_IPV4, G_SOCKET_TYPE_DATAGRAM, G_SOCKET_PROTOCOL_UDP,
                             nullptr)),
        to_(g_inet_socket_address_new_from_string("127.0.0.1", port)) {
    if (*from == '\0') return;
    GSocketAddress* own = g_inet_socket_address_new_from_string(from, 0);
    EXPECT_TRUE(g_socket_bind(socket_, own, FALSE, nullptr));
    g_object_unref(own);
  }
  ~UdpSender() {
    g_object_unref(socket_);
    g_object_unref(to_);
  }
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  void Send(const std::vector<std::uint8_t>& payload) {
    ASSERT_EQ(g_socket_send_to(socket_, to_, reinterpret_cast<const gchar*>(payload.data()),
                               payload.size(), nullptr, nullptr),
              static_cast<gssize>(payload.size()));
  }

 private:
  GSocket* socket_;
  GSocketAddress* to_;
};

struct Ending {
  std::string error;     // error and its details; empty after EOS
  std::string warnings;  // the texts of all warnings
};

/// Returns the text and the details of an error or warning message.
inline std::string TextOf(GstMessage* message) {
  return MessageText(message) + "\n" + MessageDetails(message);
}

/// Runs a pipeline until EOS or an error.
inline Ending Run(const std::string& description) {
  GError* raw = nullptr;
  const gst::ElementPtr pipeline(gst_parse_launch(description.c_str(), &raw));
  const gst::ErrorPtr parse_error(raw);
  if (parse_error) return {parse_error->message, {}};
  gst_element_set_state(pipeline.get(), GST_STATE_PLAYING);
  const ElementBus bus(pipeline.get());
  Ending ending{"no end", {}};
  for (bool ended = false; !ended;) {
    const gst::MessagePtr message =
        bus.Wait(GST_MESSAGE_ERROR | GST_MESSAGE_WARNING | GST_MESSAGE_EOS);
    ended = !message || GST_MESSAGE_TYPE(message.get()) != GST_MESSAGE_WARNING;
    if (!message) break;
    if (!ended)
      ending.warnings += TextOf(message.get());
    else
      ending.error =
          GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_ERROR ? TextOf(message.get()) : "";
  }
  gst_element_set_state(pipeline.get(), GST_STATE_NULL);
  return ending;
}

/// Runs a pipeline until its end. Returns the text of its error, or an empty string after EOS.
inline std::string RunToEnd(const std::string& description) { return Run(description).error; }

}  // namespace lidar::test
