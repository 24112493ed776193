// SPDX-License-Identifier: LGPL-2.1-or-later
// Functions for the tests of ros2src and ros2sink: a domain for each program, clouds, and
// pipelines.
#pragma once
#include <gio/gio.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gst/common/buffer_map.h"
#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"
#include "tests/elements/ros2/fast_peer.h"
#include "tests/support/element_bus.h"
#include "tests/support/element_stats.h"
#include "tests/support/harness.h"
#include "tests/support/patience.h"

namespace lidar::test {

constexpr const char* kCloudType = "sensor_msgs::msg::dds_::PointCloud2_";

/// Returns a domain that only this program uses until it ends. Domains 1 to 9 use the UDP ports
/// 7650 to 9899. These numbers are below the ports that the kernel assigns, and below those of
/// other tests. To mark a domain as taken, binds a TCP socket to the number of the domain's first
/// UDP port.
inline std::uint32_t TestDomain() {
  using Object = std::unique_ptr<void, decltype(&g_object_unref)>;
  static const Object mark(
      g_socket_new(G_SOCKET_FAMILY_IPV4, G_SOCKET_TYPE_STREAM, G_SOCKET_PROTOCOL_DEFAULT, nullptr),
      g_object_unref);
  static const std::uint32_t domain = [] {
    for (std::uint32_t candidate = 1;; candidate = candidate % 9 + 1) {
      const Object address(
          g_inet_socket_address_new_from_string("127.0.0.1", 7400 + 250 * candidate),
          g_object_unref);
      if (g_socket_bind(G_SOCKET(mark.get()), G_SOCKET_ADDRESS(address.get()), FALSE, nullptr))
        return candidate;
    }
  }();
  return domain;
}

/// Returns a cloud whose points have 24 bytes: x, y, z, intensity, a time and a range. The bytes
/// are random numbers that depend on `seed`.
inline PeerCloud TestCloud(std::uint32_t width, std::uint32_t height, unsigned seed = 1) {
  PeerCloud cloud;
  cloud.header = {1'700'000'000 + static_cast<std::int32_t>(seed), 123'456'789, "os_lidar"};
  cloud.width = width;
  cloud.height = height;
  cloud.fields = {{"x", 0, 7, 1},          {"y", 4, 7, 1},  {"z", 8, 7, 1},
                  {"intensity", 12, 7, 1}, {"t", 16, 6, 1}, {"range", 20, 6, 1}};
  cloud.point_step = 24;
  cloud.row_step = 24 * width;
  cloud.data.resize(std::size_t{24} * width * height);
  std::uint32_t state = seed * 2654435761u + 1;
  for (auto& byte : cloud.data) {
    state = state * 1664525u + 1013904223u;
    byte = static_cast<std::uint8_t>(state >> 24);
  }
  return cloud;
}
constexpr const char* kTestFields =
    "x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,t:U32:16,range:U32:20";
constexpr GstClockTime kTestNs = 123'456'789;

inline gst::CapsPtr CloudCaps(const PeerCloud& cloud, const char* extra = "") {
  char text[400];
  std::snprintf(text, sizeof text,
                "application/x-pointcloud2,width=%u,height=%u,point-step=24,fields=(string)\"%s\","
                "is-bigendian=false,is-dense=%s%s",
                cloud.width, cloud.height, kTestFields, cloud.is_dense ? "true" : "false", extra);
  return gst::CapsPtr(gst_caps_from_string(text));
}

/// Returns a buffer with the points and the time of the cloud.
inline GstBuffer* CloudBuffer(const PeerCloud& cloud) {
  GstBuffer* buffer = gst_buffer_new_memdup(cloud.data.data(), cloud.data.size());
  gst_lidar_buffer_set_capture_time(
      buffer, static_cast<GstClockTime>(cloud.header.sec) * GST_SECOND + cloud.header.nanosec);
  return buffer;
}

inline std::vector<std::uint8_t> BytesOf(GstBuffer* buffer) {
  const gst::BufferMap map(buffer, GST_MAP_READ);
  return {map.view().begin(), map.view().end()};
}

/// A fixture with an element in TestDomain(), alone or with elements after it.
class Ros2Test : public ::testing::Test {
 protected:
  void Start(const std::string& element, const std::string& properties,
             const std::string& behind = "") {
    const std::string line =
        element + " name=ros domain-id=" + std::to_string(TestDomain()) + " " + properties + behind;
    h_.reset(gst_harness_new_parse(line.c_str()));
    ASSERT_NE(h_, nullptr);
    bus_.emplace(h_->element);
    ros_.reset(GST_IS_BIN(h_->element) ? gst_bin_get_by_name(GST_BIN(h_->element), "ros")
                                       : GST_ELEMENT(gst_object_ref(h_->element)));
    SetPlaying(h_.get());
  }
  /// Stops the element and starts it again. If the element is a sink, sends it the events of a new
  /// stream.
  void StartAgain(const char* caps = nullptr) {
    gst_element_set_state(h_->element, GST_STATE_NULL);
    while (NextComplaint(0) != "") continue;
    SetPlaying(h_.get());
    if (caps == nullptr) return;
    gst_harness_push_event(h_.get(), gst_event_new_stream_start("again"));
    gst_harness_set_src_caps_str(h_.get(), caps);
  }
  gst::BufferPtr Pull() { return gst::BufferPtr(gst_harness_pull(h_.get())); }
  /// Returns a field of the caps that the harness received, as text.
  std::string Field(const char* name) {
    const gst::CapsPtr caps(gst_pad_get_current_caps(h_->sinkpad));
    const GValue* value = gst_structure_get_value(gst_caps_get_structure(caps.get(), 0), name);
    if (value == nullptr) return "";
    const gst::StringPtr text(G_VALUE_HOLDS_STRING(value) ? g_value_dup_string(value)
                                                          : gst_value_serialize(value));
    return text.get();
  }
  guint64 Stat(const char* name) { return StatOf(ros_.get(), name); }
  /// Waits until the counter `name` is at least `least`. Returns false if that takes too long.
  bool WaitForStat(const char* name, guint64 least) {
    return Eventually([&] { return Stat(name) >= least; });
  }
  bool WaitForNone(const char* name) {
    return Eventually([&] { return Stat(name) == 0; });
  }
  /// Waits for a warning or an error. Returns its text, or an empty string if none is posted in
  /// time.
  std::string NextComplaint(GstClockTime timeout = kPatience_ns) {
    const gst::MessagePtr message = bus_->Wait(GST_MESSAGE_WARNING | GST_MESSAGE_ERROR, timeout);
    return message ? MessageText(message.get()) : "";
  }
  /// Returns NextComplaint(), but skips a warning about the receive buffer, which depends on the
  /// machine.
  std::string NextOwnComplaint() {
    std::string text = NextComplaint();
    if (text.find("receive buffer") != std::string::npos) text = NextComplaint();
    return text;
  }

  Harness h_;
  std::unique_ptr<GstElement, gst::Unref> ros_;
  std::optional<ElementBus> bus_;
};

}  // namespace lidar::test
