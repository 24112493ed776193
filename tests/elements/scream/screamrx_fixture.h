// SPDX-License-Identifier: LGPL-2.1-or-later
// A fixture with a screamrx between harnesses, under a test clock.
#pragma once
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "gst/scream/rtp_packet.h"
#include "src/rtcp/sender_report.h"
#include "tests/elements/scream/rtp_support.h"

namespace lidar::test {

using gst::CapsPtr;
using rtcp::CongestionFeedback;

class ScreamRx : public ::testing::Test {
 protected:
  FakeTime time;
  GstElement* element = gst_element_factory_make("screamrx", nullptr);
  Harness rtp;
  Harness rtcp;

  void Start() {
    rtp.reset(gst_harness_new_with_element(element, "sink", "src"));
    rtcp.reset(gst_harness_new_with_element(element, nullptr, "rtcp_src"));
    gst_harness_set_src_caps_str(rtp.get(), kRtpCaps);
  }
  void Restart() {
    gst_element_set_state(element, GST_STATE_NULL);
    gst_harness_play(rtp.get());
    gst_harness_play(rtcp.get());
  }
  void SetPtMap(const std::string& types) {
    const gst::StructurePtr map(
        gst_structure_from_string(("application/x-rtp-pt-map," + types).c_str(), nullptr));
    ASSERT_TRUE(map);
    g_object_set(element, "pt-map", map.get(), nullptr);
  }
  void TearDown() override {
    rtcp.reset();
    rtp.reset();
    gst_object_unref(element);
  }
  GstFlowReturn Push(const Rtp& r, GstLidarEcn ecn = GST_LIDAR_ECN_ECT1, const char* host = nullptr,
                     guint port = 5000) {
    GstBuffer* buffer = NewRtp(r);
    gst_lidar_buffer_set_ecn(buffer, ecn, GST_CLOCK_TIME_NONE);
    if (host != nullptr) SetSource(buffer, host, port);
    return gst_harness_push(rtp.get(), buffer);
  }
  /// Starts with payload type 96 in pt-map, and with `caps` after the pad `src`. A goodbye does not
  /// end the stream.
  void StartAndOutliveByes(const char* caps) {
    SetPtMap(
        "96=(string)\"application/x-rtp,media=application,clock-rate=90000,encoding-name=TEST\"");
    g_object_set(element, "eos-on-bye", FALSE, nullptr);
    Start();
    gst_harness_set_sink_caps_str(rtp.get(), caps);
  }
  GstFlowReturn PushBye(std::vector<guint32> ssrcs, const char* host = nullptr) {
    GstBuffer* buffer = FromBytes(gst::BuildBye(ssrcs));
    if (host != nullptr) SetSource(buffer, host, 5000);
    return gst_harness_push(rtp.get(), buffer);
  }
  GstFlowReturn PushReport(const rtcp::SenderReport& report, const char* host = "10.0.0.1") {
    GstBuffer* buffer = FromBytes(rtcp::BuildSenderReport(report));
    SetSource(buffer, host, 5000);
    return gst_harness_push(rtp.get(), buffer);
  }
  CongestionFeedback Report(BufferPtr* raw = nullptr) {
    BufferPtr buffer(gst_harness_pull(rtcp.get()));
    if (!buffer) return {};
    const auto bytes = ToBytes(buffer.get());
    const auto report = rtcp::CcfbParser().Parse({bytes.data(), bytes.size()});
    if (raw != nullptr) *raw = std::move(buffer);
    EXPECT_TRUE(report);
    return report.value_or(CongestionFeedback{});
  }
  /// Pushes the very first packet. screamrx reports this packet at once, but later packets only
  /// after some time.
  void PushFirst(guint16 seq) {
    Rtp r;
    r.seq = seq;
    ASSERT_EQ(Push(r), GST_FLOW_OK);
    Report();
    time.Settle();
  }
  guint Passed() { return gst_harness_buffers_received(rtp.get()); }
};

}  // namespace lidar::test
