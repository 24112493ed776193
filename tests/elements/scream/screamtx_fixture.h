// SPDX-License-Identifier: LGPL-2.1-or-later
// A fixture with a screamtx between harnesses, under a test clock.
#pragma once
#include <gst/net/gstnetaddressmeta.h>
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "gst/net/udp_socket.h"
#include "gst/scream/rtp_packet.h"
#include "tests/elements/scream/rtp_support.h"
#include "tests/support/patience.h"

namespace lidar::test {

class ScreamTx : public ::testing::Test {
 protected:
  FakeTime time;
  GstElement* element = gst_element_factory_make("screamtx", nullptr);
  Harness rtp;
  Harness rtcp;
  std::vector<Rtp> sent;

  void Start(const char* caps = kRtpCaps) {
    rtp.reset(gst_harness_new_with_element(element, "sink_0", "src"));
    rtcp.reset(gst_harness_new_with_element(element, "rtcp_sink", "rtcp_src"));
    gst_harness_set_src_caps_str(rtp.get(), caps);
    gst_harness_set_src_caps_str(rtcp.get(), "application/x-rtcp");
  }
  /// Starts without an element after rtcp_src. Therefore screamtx drops RTCP that is not for
  /// itself.
  void StartAsLast(const char* caps) {
    rtp.reset(gst_harness_new_with_element(element, "sink_0", "src"));
    rtcp.reset(gst_harness_new_with_element(element, "rtcp_sink", nullptr));
    gst_harness_set_src_caps_str(rtp.get(), caps);
    gst_harness_set_src_caps_str(rtcp.get(), "application/x-rtcp");
  }
  /// Stops the element, and starts it again with the caps of Start().
  void Restart() {
    gst_element_set_state(element, GST_STATE_NULL);
    gst_harness_play(rtp.get());
    gst_harness_play(rtcp.get());
    gst_harness_set_src_caps_str(rtp.get(), kRtpCaps);
    gst_harness_set_src_caps_str(rtcp.get(), "application/x-rtcp");
  }
  void TearDown() override {
    rtcp.reset();
    rtp.reset();
    gst_object_unref(element);
  }
  GstFlowReturn Push(const Rtp& r) { return gst_harness_push(rtp.get(), NewRtp(r)); }
  /// Pushes a frame that consists of `packets` packets with the next sequence numbers.
  void PushFrame(guint32 timestamp, int packets) {
    for (int i = 0; i < packets; ++i) {
      Rtp r;
      r.seq = next_seq_++;
      r.timestamp = timestamp;
      r.marker = i + 1 == packets;
      ASSERT_EQ(Push(r), GST_FLOW_OK);
    }
  }
  /// Adds the packets that the element has sent since the last call to `sent` and `byes`.
  void Collect() {
    time.Settle();
    while (BufferPtr buffer{gst_harness_try_pull(rtp.get())}) {
      const auto bytes = ToBytes(buffer.get());
      if (gst::IsRtcp({bytes.data(), bytes.size()})) {
        byes.push_back(bytes);
        continue;
      }
      sent.push_back(ReadRtp(buffer.get()));
      GstLidarEcn ecn{};
      ecns.push_back(gst_lidar_buffer_get_ecn(buffer.get(), &ecn, nullptr) ? static_cast<int>(ecn)
                                                                           : -1);
    }
  }
  /// Pushes a report about all packets that were sent but not reported yet.
  void Acknowledge(Ecn ecn = Ecn::kEct1) {
    Collect();
    if (acknowledged_ == sent.size()) return;
    rtcp::CongestionFeedback report;
    report.sender_ssrc = receiver;
    report.report_timestamp = static_cast<std::uint32_t>(
        gst_util_uint64_scale(time.now(), 65536, GST_SECOND) & 0xffffffff);
    std::map<guint32, rtcp::SsrcReport> blocks;
    for (; acknowledged_ < sent.size(); ++acknowledged_) {
      const Rtp& r = sent[acknowledged_];
      auto& block = blocks[r.ssrc];
      if (block.metrics.empty()) block.begin_seq = r.seq;
      block.ssrc = r.ssrc;
      block.metrics.push_back({true, ecn, Duration{0}});
    }
    for (auto& [ssrc, block] : blocks) report.blocks.push_back(block);
    Feed(report);
  }
  void Feed(const rtcp::CongestionFeedback& report) {
    GstBuffer* buffer = FromBytes(rtcp::BuildCcfb(report));
    if (from) gst_buffer_add_net_address_meta(buffer, from.get());
    ASSERT_EQ(gst_harness_push(rtcp.get(), buffer), GST_FLOW_OK);
  }
  /// Returns the target-bitrate events that have arrived upstream since the last call.
  static std::vector<GstLidarTargetBitrate> Targets(GstHarness* h) {
    std::vector<GstLidarTargetBitrate> targets;
    while (EventPtr event{gst_harness_try_pull_upstream_event(h)}) {
      GstLidarTargetBitrate target{};
      if (gst_lidar_event_parse_target_bitrate(event.get(), &target)) {
        target.reason = g_intern_string(target.reason);
        targets.push_back(target);
      }
    }
    return targets;
  }
  static GstEvent* WaitForUpstream(GstHarness* h, const char* name) {
    for (;;) {
      GstEvent* event = gst_harness_pull_upstream_event(h);
      if (event == nullptr || gst_event_has_name(event, name)) return event;
      gst_event_unref(event);
    }
  }
  /// Returns the names of all upstream events that arrive until the target has been repeated three
  /// times.
  std::multiset<std::string> NamesUpstream(GstHarness* h) {
    std::multiset<std::string> names;
    const auto note = [&](GstEvent* event) {
      const GstStructure* s = gst_event_get_structure(event);
      return *names.insert(s != nullptr ? gst_structure_get_name(s) : GST_EVENT_TYPE_NAME(event));
    };
    while (EventPtr event{gst_harness_try_pull_upstream_event(h)}) note(event.get());
    for (int pulse = 0; pulse < 3; ++pulse) {
      time.Advance(250 * GST_MSECOND);
      EventPtr event(gst_harness_pull_upstream_event(h));
      while (event && note(event.get()) != "target-bitrate")
        event.reset(gst_harness_pull_upstream_event(h));
    }
    return names;
  }
  /// Discards the upstream events that were caused earlier. Returns the second repetition of the
  /// target. A thread sends the events, so the first may be one that was made earlier.
  GstLidarTargetBitrate NextTarget(GstHarness* h) {
    Targets(h);
    GstLidarTargetBitrate target{};
    for (int pulse = 0; pulse < 2; ++pulse) {
      time.Advance(250 * GST_MSECOND);
      const EventPtr event(WaitForUpstream(h, "target-bitrate"));
      if (event) gst_lidar_event_parse_target_bitrate(event.get(), &target);
    }
    return target;
  }
  bool HasEos() {
    bool eos = false;
    while (EventPtr event{gst_harness_try_pull_event(rtp.get())})
      eos = eos || GST_EVENT_TYPE(event.get()) == GST_EVENT_EOS;
    return eos;
  }
  bool Ends() {
    time.Advance(10 * GST_MSECOND);
    return HasEos();
  }
  /// Waits until a packet leaves the element. Returns false if that takes too long.
  bool Leaves() {
    return Eventually([this] { return BufferPtr(gst_harness_try_pull(rtp.get())) != nullptr; });
  }
  /// Pushes a packet and EOS, and calls `begin_anew`. Does this twice.
  void StreamTwice(const std::function<void()>& begin_anew) {
    Start();
    for (int round = 0; round < 2; ++round) {
      PushFrame(static_cast<guint32>(round), 1);
      gst_harness_push_event(rtp.get(), gst_event_new_eos());
      for (int i = 0; i < 10; ++i) {
        time.Advance(10 * GST_MSECOND);
        Acknowledge();
      }
      EXPECT_TRUE(HasEos()) << round;
      begin_anew();
      ASSERT_TRUE(gst_harness_push_event(rtp.get(), NewSegment()));
    }
    EXPECT_EQ(sent.size(), 2U);
  }

  // Source address of the feedback; null: none.
  std::unique_ptr<GSocketAddress, gst::GObjectUnref> from;
  guint32 receiver = 9;  // SSRC from which the reports come
  std::vector<int> ecns;
  std::vector<std::vector<std::uint8_t>> byes;
  guint16 next_seq_ = 0;
  std::size_t acknowledged_ = 0;
};

}  // namespace lidar::test
