// SPDX-License-Identifier: LGPL-2.1-or-later
// An ouster_src that receives from a sensor on this machine, and its buffers and messages.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "tests/elements/ouster/ouster_support.h"
#include "tests/support/clock_wait.h"
#include "tests/support/patience.h"

namespace lidar::test {

/// An ouster_src in a harness, and the messages on its bus.
class Receiver {
 public:
  Receiver(const std::string& host, const std::string& properties)
      : Receiver(host, properties, {FreePort(), FreePort()}) {}
  struct Ports {
    guint16 lidar;
    guint16 imu;
  };
  enum class Clock { kSystem, kTest };
  Receiver(const std::string& host, const std::string& properties, Ports ports,
           Clock clock = Clock::kSystem)
      : port_(ports.lidar) {
    const std::string launch = "ouster_src name=src hostname=" + host +
                               " imu-port=" + std::to_string(ports.imu) +
                               " lidar-port=" + std::to_string(port_) + " " + properties;
    harness_.reset(gst_harness_new_parse(launch.c_str()));
    source_.reset(gst_bin_get_by_name(GST_BIN(harness_->element), "src"));
    bus_.emplace(harness_->element);
    if (clock == Clock::kTest) {
      UseTestClock(harness_.get());
      Pass(3600 * GST_SECOND);  // later than running time 0, because earlier packets are dropped
    } else {
      gst_harness_use_systemclock(harness_.get());
    }
    SetPlaying(harness_.get());
  }

  /// Lets time pass on the test clock.
  void Pass(GstClockTime time) { gst_harness_set_time(harness_.get(), now_ += time); }
  void SetState(GstState state) { gst_element_set_state(harness_->element, state); }
  /// Returns the next buffer. Returns null if none arrives in time or if the element has ended the
  /// stream, for example after an error.
  gst::BufferPtr Pull() { return Pull(g_get_monotonic_time() + kPatience_us); }
  void Drain() {
    while (gst_harness_buffers_in_queue(harness_.get()) > 0) Pull();
  }
  /// Pulls buffers until `wanted` returns true for a buffer. Returns false if that takes too long.
  bool PullUntil(const std::function<bool(GstBuffer*)>& wanted) {
    const gint64 end = g_get_monotonic_time() + kPatience_us;
    while (const gst::BufferPtr buffer = Pull(end))
      if (wanted(buffer.get())) return true;
    return false;
  }
  gst::CloudInfo Info() {
    const gst::CapsPtr caps(gst_pad_get_current_caps(harness_->sinkpad));
    const auto info = gst::CloudInfo::FromCaps(caps.get());
    EXPECT_TRUE(info);
    return info.value_or(gst::CloudInfo{});
  }
  /// Waits for the next element message `name`. Returns null if the element posts an error.
  gst::MessagePtr Await(const char* name) {
    for (;;) {
      gst::MessagePtr message = bus_->Wait(GST_MESSAGE_ELEMENT | GST_MESSAGE_ERROR);
      if (!message || GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_ERROR) return nullptr;
      if (gst_message_has_name(message.get(), name)) return message;
    }
  }
  bool AwaitConnected(bool connected) {
    for (;;) {
      const gst::MessagePtr message = Await("ouster-connection-changed");
      if (!message || IsConnected(message.get()) == connected) return message != nullptr;
    }
  }
  /// Lets time pass on the test clock until the element posts that the sensor is disconnected.
  bool PassUntilDisconnected() {
    return Eventually([this] {
      Pass(GST_SECOND);
      const gst::MessagePtr message = bus_->Pop(GST_MESSAGE_ELEMENT);
      return message && gst_message_has_name(message.get(), "ouster-connection-changed") &&
             !IsConnected(message.get());
    });
  }
  /// Waits until the element has posted that its latency changed. Returns false if that takes too
  /// long.
  bool AwaitLatency() { return bus_->Wait(GST_MESSAGE_LATENCY) != nullptr; }
  bool AwaitWarning(const std::string& part) {
    for (;;) {
      const gst::MessagePtr message = bus_->Wait(GST_MESSAGE_WARNING);
      if (!message) return false;
      if (MessageText(message.get()).find(part) != std::string::npos) return true;
    }
  }
  std::string AwaitError() {
    const gst::MessagePtr message = bus_->Wait(GST_MESSAGE_ERROR);
    return message ? MessageText(message.get()) : "no error";
  }
  GstElement* source() { return source_.get(); }
  guint16 port() const { return port_; }

 private:
  /// Returns the state that an ouster-connection-changed message reports.
  static bool IsConnected(GstMessage* message) {
    gboolean is = FALSE;
    EXPECT_TRUE(gst_structure_get_boolean(gst_message_get_structure(message), "connected", &is));
    return is != FALSE;
  }
  gst::BufferPtr Pull(gint64 end) {
    for (;;) {
      const bool ended = GST_PAD_IS_EOS(harness_->sinkpad);
      gst::BufferPtr buffer(gst_harness_try_pull(harness_.get()));
      if (buffer || ended || g_get_monotonic_time() >= end) return buffer;
      g_usleep(500);
    }
  }

  guint16 port_;
  GstClockTime now_ = kClockStart;
  Harness harness_;
  gst::ElementPtr source_;
  std::optional<ElementBus> bus_;
};

}  // namespace lidar::test
