// SPDX-License-Identifier: LGPL-2.1-or-later
// screamtx under a test clock: what leaves when, what goes upstream, what it believes.
#include <gtest/gtest.h>

#include <map>

#include "rtp_support.h"
#include "scream/rtp_packet.h"

namespace lidar::test {
namespace {

using gst::BuildBye;
using scream::CongestionFeedback;

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
  void TearDown() override {
    rtcp.reset();
    rtp.reset();
    gst_object_unref(element);
  }
  GstFlowReturn Push(const Rtp& r) { return gst_harness_push(rtp.get(), NewRtp(r)); }
  /// A frame of `packets`, with the next sequence numbers.
  void PushFrame(guint32 timestamp, int packets) {
    for (int i = 0; i < packets; ++i) {
      Rtp r;
      r.seq = next_seq_++;
      r.timestamp = timestamp;
      r.marker = i + 1 == packets;
      ASSERT_EQ(Push(r), GST_FLOW_OK);
    }
  }
  /// Takes what has left so far.
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
  /// A report of all packets sent and not yet reported.
  void Acknowledge(scream::Ecn ecn = scream::Ecn::kEct1) {
    Collect();
    if (acknowledged_ == sent.size()) return;
    CongestionFeedback report;
    report.sender_ssrc = 9;
    report.report_timestamp = static_cast<std::uint32_t>(
        gst_util_uint64_scale(time.now(), 65536, GST_SECOND) & 0xffffffff);
    std::map<guint32, scream::SsrcReport> blocks;
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
  void Feed(const CongestionFeedback& report) {
    ASSERT_EQ(gst_harness_push(rtcp.get(), FromBytes(scream::BuildCcfb(report))), GST_FLOW_OK);
  }
  /// The target-bitrate events that reached upstream so far.
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
  /// The target that the pulse brings, long after everything before.
  GstLidarTargetBitrate NextTarget(GstHarness* h) {
    g_usleep(20'000);  // the control thread runs on real time; what is left over comes now
    Targets(h);
    time.Advance(250 * GST_MSECOND);
    GstLidarTargetBitrate target{};
    const EventPtr event(WaitForUpstream(h, "target-bitrate"));
    if (event) gst_lidar_event_parse_target_bitrate(event.get(), &target);
    return target;
  }
  bool HasEos() {
    bool eos = false;
    while (EventPtr event{gst_harness_try_pull_event(rtp.get())})
      eos = eos || GST_EVENT_TYPE(event.get()) == GST_EVENT_EOS;
    return eos;
  }

  std::vector<int> ecns;
  std::vector<std::vector<std::uint8_t>> byes;
  guint16 next_seq_ = 0;
  std::size_t acknowledged_ = 0;
};

TEST_F(ScreamTx, TellsTheEncoderItsStartBitrateWithTheCaps) {
  g_object_set(element, "start-bitrate", 2'000'000, nullptr);
  Start();
  const auto targets = Targets(rtp.get());
  ASSERT_GE(targets.size(), 1U);
  EXPECT_STREQ(targets[0].reason, "start");
  // The headers of 1200-byte packets are taken off.
  EXPECT_NEAR(targets[0].bitrate, 2'000'000.0 * 1188 / 1228, 1000);
}

TEST_F(ScreamTx, TellsTheEncoderItsTargetAtLeastEvery200Ms) {
  Start();
  Targets(rtp.get());
  for (int i = 0; i < 10; ++i) {
    time.Advance(201 * GST_MSECOND);
    const EventPtr event(WaitForUpstream(rtp.get(), "target-bitrate"));
    ASSERT_TRUE(event);
  }
}

TEST_F(ScreamTx, MarksPacketsAsTheControllerSays) {
  Start();
  PushFrame(0, 1);
  const BufferPtr out(gst_harness_pull(rtp.get()));
  ASSERT_TRUE(out);
  GstLidarEcn ecn{};
  ASSERT_TRUE(gst_lidar_buffer_get_ecn(out.get(), &ecn, nullptr));
  EXPECT_EQ(ecn, GST_LIDAR_ECN_ECT1);
}

TEST_F(ScreamTx, WithoutEcnLeavesBuffersAlone) {
  gst_util_set_object_arg(G_OBJECT(element), "ecn-mode", "off");
  Start();
  GstBuffer* in = NewRtp({});
  GST_BUFFER_PTS(in) = 123;
  GST_BUFFER_DTS(in) = 45;
  ASSERT_EQ(gst_harness_push(rtp.get(), gst_buffer_ref(in)), GST_FLOW_OK);
  const BufferPtr out(gst_harness_pull(rtp.get()));
  EXPECT_EQ(out.get(), in);
  EXPECT_EQ(GST_BUFFER_PTS(out.get()), 123U);
  EXPECT_EQ(GST_BUFFER_DTS(out.get()), 45U);
  gst_buffer_unref(in);
}

TEST_F(ScreamTx, SendsNoMoreThanTheWindowWithoutFeedback) {
  Start();
  PushFrame(0, 100);
  time.Advance(100 * GST_MSECOND);
  Collect();
  EXPECT_GE(sent.size(), 1U);
  EXPECT_LE(sent.size(), 20U);
  EXPECT_EQ(Stats(element)["packets-sent"], sent.size());
}

TEST_F(ScreamTx, GoesOnWithFeedbackInOrderAndWithoutLoss) {
  Start();
  for (guint32 frame = 0; frame < 20; ++frame) {
    PushFrame(frame * 9000, 8);
    for (int i = 0; i < 10; ++i) {
      time.Advance(10 * GST_MSECOND);
      Acknowledge();
    }
  }
  Collect();
  ASSERT_EQ(sent.size(), 160U);
  for (std::size_t i = 0; i < sent.size(); ++i) EXPECT_EQ(sent[i].seq, i);
  EXPECT_EQ(Stats(element)["frames-dropped"], 0U);
  EXPECT_EQ(Stats(element).Text("ecn-state"), "capable");
}

TEST_F(ScreamTx, RaisesTheTargetOnAFreePathAndLowersItUnderMarks) {
  g_object_set(element, "start-bitrate", 1'000'000, nullptr);
  Start();
  const auto run = [&](int frames, scream::Ecn ecn) {
    for (int i = 0; i < frames; ++i) {
      PushFrame(static_cast<guint32>(sent.size()) * 900, 8);
      for (int k = 0; k < 5; ++k) {
        time.Advance(5 * GST_MSECOND);
        Acknowledge(ecn);
      }
    }
  };
  run(40, scream::Ecn::kEct1);
  const guint64 free = Stats(element)["target-bitrate"];
  EXPECT_GT(free, 1'200'000U);
  Targets(rtp.get());
  run(40, scream::Ecn::kCe);
  EXPECT_LT(Stats(element)["target-bitrate"], free / 2);
  EXPECT_GT(Stats(element)["packets-ce"], 0U);
  GstLidarTargetBitrate told{};
  do {
    const EventPtr event(WaitForUpstream(rtp.get(), "target-bitrate"));
    ASSERT_TRUE(event);
    ASSERT_TRUE(gst_lidar_event_parse_target_bitrate(event.get(), &told));
  } while (told.bitrate >= free / 2);
  EXPECT_GT(told.rtt, 0U);
}

TEST_F(ScreamTx, DropsLateFramesOfLiveInputWhole) {
  g_object_set(element, "max-queue-delay", guint64{100 * GST_MSECOND}, nullptr);
  Start();
  for (guint32 frame = 0; frame < 5; ++frame) {
    PushFrame(frame * 900, 30);
    time.Advance(10 * GST_MSECOND);
  }
  time.Advance(110 * GST_MSECOND);
  PushFrame(99999, 2);
  for (int i = 0; i < 50; ++i) {
    time.Advance(10 * GST_MSECOND);
    Acknowledge();
  }
  Collect();
  std::map<guint32, int> packets;
  for (const Rtp& r : sent) ++packets[r.timestamp];
  EXPECT_EQ(packets[0], 30);  // it had begun to leave
  EXPECT_EQ(packets[99999], 2);
  EXPECT_EQ(packets.size(), 2U);
  const Stats stats(element);
  EXPECT_EQ(stats["frames-dropped"], 4U);
  EXPECT_EQ(stats["packets-dropped"], 120U);
}

TEST_F(ScreamTx, GivesUpTheRestOfAFrameThatStuckOnItsWay) {
  g_object_set(element, "max-queue-delay", guint64{100 * GST_MSECOND}, nullptr);
  Start();
  PushFrame(0, 100);
  time.Advance(190 * GST_MSECOND);
  EXPECT_EQ(Stats(element)["frames-dropped"], 0U);
  time.Advance(15 * GST_MSECOND);
  EXPECT_EQ(Stats(element)["frames-dropped"], 1U);
  EXPECT_EQ(Stats(element)["queued-bytes"], 0U);
}

TEST_F(ScreamTx, AsksAVideoEncoderForAKeyFrameAfterADrop) {
  g_object_set(element, "max-queue-delay", guint64{100 * GST_MSECOND}, nullptr);
  Start(kVideoCaps);
  PushFrame(0, 30);
  PushFrame(900, 30);
  time.Advance(300 * GST_MSECOND);
  const EventPtr event(WaitForUpstream(rtp.get(), "GstForceKeyUnit"));
  EXPECT_TRUE(event);
}

TEST_F(ScreamTx, EosDrainsTheQueue) {
  g_object_set(element, "send-bye", TRUE, nullptr);
  Start();
  PushFrame(0, 20);
  gst_harness_push_event(rtp.get(), gst_event_new_eos());
  for (int i = 0; i < 15; ++i) {
    time.Advance(10 * GST_MSECOND);
    Acknowledge();
  }
  Collect();
  EXPECT_EQ(sent.size(), 20U);
  EXPECT_TRUE(HasEos());
  ASSERT_GE(byes.size(), 2U);  // one may be lost
  EXPECT_EQ(gst::ParseBye({byes[0].data(), byes[0].size()}), std::vector<guint32>{0x1234});
}

TEST_F(ScreamTx, EosDoesNotWaitForAPathThatIsGone) {
  g_object_set(element, "max-queue-delay", guint64{150 * GST_MSECOND}, nullptr);
  Start();
  PushFrame(0, 200);
  gst_harness_push_event(rtp.get(), gst_event_new_eos());
  time.Advance(140 * GST_MSECOND);
  EXPECT_FALSE(HasEos());
  time.Advance(20 * GST_MSECOND);
  EXPECT_TRUE(HasEos());
  Collect();
  EXPECT_LT(sent.size(), 200U);
  EXPECT_TRUE(byes.empty());
}

TEST_F(ScreamTx, PassesForeignRtcpAndKeepsItsOwn) {
  Start();
  PushFrame(0, 1);
  Collect();
  std::vector<std::uint8_t> receiver_report{0x80, 201, 0, 1, 0, 0, 0, 5};
  CongestionFeedback ours;
  ours.blocks.push_back({0x1234, 0, {{true, scream::Ecn::kEct1, Duration{0}}}});
  const auto ccfb = scream::BuildCcfb(ours);
  auto compound = receiver_report;
  compound.insert(compound.end(), ccfb.begin(), ccfb.end());
  ASSERT_EQ(gst_harness_push(rtcp.get(), FromBytes(compound)), GST_FLOW_OK);
  const BufferPtr out(gst_harness_pull(rtcp.get()));
  EXPECT_EQ(ToBytes(out.get()), receiver_report);

  ours.blocks[0].ssrc = 0x9999;  // of another sender behind us
  const auto theirs = scream::BuildCcfb(ours);
  ASSERT_EQ(gst_harness_push(rtcp.get(), FromBytes(theirs)), GST_FLOW_OK);
  const BufferPtr passed(gst_harness_pull(rtcp.get()));
  EXPECT_EQ(ToBytes(passed.get()), theirs);
}

TEST_F(ScreamTx, PassesRtcpGarbageUnread) {
  Start();
  for (const auto& bytes :
       {std::vector<std::uint8_t>{1, 2, 3}, std::vector<std::uint8_t>{0x8b, 205, 0, 99, 0, 0, 0, 1},
        std::vector<std::uint8_t>{0x8b, 205, 0, 1, 0, 0, 0, 1}}) {
    ASSERT_EQ(gst_harness_push(rtcp.get(), FromBytes(bytes)), GST_FLOW_OK);
    const BufferPtr out(gst_harness_pull(rtcp.get()));
    EXPECT_EQ(ToBytes(out.get()), bytes);
  }
}

TEST_F(ScreamTx, IgnoresFeedbackOfPacketsThatItNeverSent) {
  Start();
  for (guint32 i = 0; i < 10; ++i) {
    PushFrame(i * 900, 2);
    time.Advance(10 * GST_MSECOND);
    Acknowledge();
  }
  const guint64 before = Stats(element)["target-bitrate"];
  CongestionFeedback lie;
  scream::SsrcReport block{0x1234, 30000, {}};
  for (int i = 0; i < 50; ++i) block.metrics.push_back({true, scream::Ecn::kCe, Duration{0}});
  lie.blocks.push_back(block);
  for (int i = 0; i < 20; ++i) Feed(lie);
  const Stats after(element);
  EXPECT_EQ(after["target-bitrate"], before);
  EXPECT_EQ(after["packets-ce"], 0U);
  EXPECT_EQ(after["feedback-ignored"], 20U);
}

TEST_F(ScreamTx, CountsWhatIsNoRtp) {
  Start();
  ASSERT_EQ(gst_harness_push(rtp.get(), FromBytes({1, 2, 3})), GST_FLOW_OK);
  ASSERT_EQ(gst_harness_push(rtp.get(), FromBytes(std::vector<std::uint8_t>(100, 0))), GST_FLOW_OK);
  PushFrame(0, 1);
  const BufferPtr out(gst_harness_pull(rtp.get()));
  EXPECT_EQ(ReadRtp(out.get()).ssrc, 0x1234U);
}

TEST_F(ScreamTx, TellsTheEncoderItsOwnBoundsAndStartsWithinThem) {
  Start();
  Targets(rtp.get());
  const GstLidarBitrateBounds bounds{3'000'000, 8'000'000, 5'000'000};
  ASSERT_TRUE(gst_harness_push_event(rtp.get(), gst_lidar_event_new_bitrate_bounds(&bounds)));
  GstLidarTargetBitrate told{};
  do {
    time.Advance(201 * GST_MSECOND);
    const EventPtr event(WaitForUpstream(rtp.get(), "target-bitrate"));
    ASSERT_TRUE(event);
    ASSERT_TRUE(gst_lidar_event_parse_target_bitrate(event.get(), &told));
  } while (told.min_bitrate < 2'000'000);
  EXPECT_NEAR(told.min_bitrate, 3'000'000, 10'000);
  EXPECT_NEAR(told.max_bitrate, 8'000'000, 10'000);
  EXPECT_GE(told.bitrate, 2'990'000U);
}

TEST_F(ScreamTx, AFlushForgetsTheQueueAndItGoesOn) {
  Start();
  PushFrame(0, 100);
  gst_harness_push_event(rtp.get(), gst_event_new_flush_start());
  EXPECT_EQ(Push({}), GST_FLOW_FLUSHING);
  gst_harness_push_event(rtp.get(), gst_event_new_flush_stop(TRUE));
  Collect();
  sent.clear();
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  gst_harness_push_event(rtp.get(), gst_event_new_segment(&segment));
  EXPECT_EQ(Stats(element)["queued-bytes"], 0U);
  acknowledged_ = 0;
  time.Advance(5 * GST_SECOND);
  PushFrame(77, 1);
  const BufferPtr out(gst_harness_pull(rtp.get()));
  ASSERT_TRUE(out);
  EXPECT_EQ(ReadRtp(out.get()).timestamp, 77U);
}

TEST_F(ScreamTx, StartsAfreshAfterEveryStateCycle) {
  Start();
  PushFrame(0, 1);
  gst_element_set_state(element, GST_STATE_NULL);
  gst_element_set_state(element, GST_STATE_PLAYING);
  EXPECT_EQ(Stats(element)["packets-sent"], 0U);
}

TEST_F(ScreamTx, AddsItsLongestDelayToTheLatency) {
  g_object_set(element, "max-queue-delay", guint64{70 * GST_MSECOND}, nullptr);
  Start();
  gst_harness_set_upstream_latency(rtp.get(), 30 * GST_MSECOND);
  EXPECT_EQ(gst_harness_query_latency(rtp.get()), 100 * GST_MSECOND);
}

TEST_F(ScreamTx, SharesTheTargetByPriority) {
  g_object_set(element, "start-bitrate", 4'000'000, "min-bitrate", 10'000, nullptr);
  Start();
  Harness second(gst_harness_new_with_element(element, "sink_1", nullptr));
  gst_harness_set_src_caps_str(second.get(), kVideoCaps);
  const gst::PadPtr pad(gst_element_get_static_pad(element, "sink_1"));
  g_object_set(pad.get(), "priority", 0.25, nullptr);
  for (int i = 0; i < 200; ++i) {
    PushFrame(static_cast<guint32>(i) * 900, 4);
    Rtp r;
    r.ssrc = 0x5678;
    r.seq = static_cast<guint16>(i);
    r.timestamp = static_cast<guint32>(i);
    r.marker = true;
    ASSERT_EQ(gst_harness_push(second.get(), NewRtp(r)), GST_FLOW_OK);
    for (int k = 0; k < 2; ++k) {
      time.Advance(5 * GST_MSECOND);
      Acknowledge(i % 4 == 0 ? scream::Ecn::kCe : scream::Ecn::kEct1);
    }
  }
  const GstLidarTargetBitrate first = NextTarget(rtp.get());
  const GstLidarTargetBitrate other = NextTarget(second.get());
  EXPECT_EQ(first.ssrc, 0x1234U);
  EXPECT_EQ(other.ssrc, 0x5678U);
  EXPECT_NEAR(static_cast<double>(first.bitrate) / other.bitrate, 4, 0.5);
}

struct Companion {
  const char* name;
  guint32 ssrc;
  guint8 payload_type;
};
class ScreamTxWith : public ScreamTx, public ::testing::WithParamInterface<Companion> {};
TEST_P(ScreamTxWith, LeavesTheEncoderWhatItsCompanionDoesNotTake) {
  g_object_set(element, "start-bitrate", 4'000'000, "min-bitrate", 4'000'000, "max-bitrate",
               4'000'000, nullptr);
  Start();
  for (guint16 i = 0; i < 400; ++i) {
    PushFrame(i * 900U, 1);
    Rtp repair;
    repair.ssrc = GetParam().ssrc;
    repair.payload_type = GetParam().payload_type;
    repair.seq = GetParam().ssrc == 0x1234 ? next_seq_++ : i;
    repair.timestamp = i * 900U;
    ASSERT_EQ(Push(repair), GST_FLOW_OK);
    time.Advance(10 * GST_MSECOND);
    Acknowledge();
  }
  const GstLidarTargetBitrate target = NextTarget(rtp.get());
  EXPECT_EQ(target.ssrc, 0x1234U);
  EXPECT_NEAR(target.bitrate, 4'000'000 * 1188.0 / 1228 / 2, 40'000);
  EXPECT_EQ(Stats(element)["packets-lost"], 0U);
}
INSTANTIATE_TEST_SUITE_P(Companions, ScreamTxWith,
                         ::testing::Values(Companion{"rtx", 0x5678, 97},
                                           Companion{"ulpfec", 0x1234, 122}),
                         [](const auto& i) { return i.param.name; });

TEST_F(ScreamTx, HoldsNoMoreThanItsDelayThroughAnOutageAndRecoversWithinASecond) {
  g_object_set(element, "start-bitrate", 4'000'000, "min-bitrate", 200'000, nullptr);
  Start();
  guint32 frame = 0;
  const auto run = [&](guint64 duration, bool path) {
    for (guint64 t = 0; t < duration; t += 20 * GST_MSECOND) {
      PushFrame(frame++ * 1800, 4);
      for (int k = 0; k < 2; ++k) {
        time.Advance(10 * GST_MSECOND);
        if (path) {
          Acknowledge();
        } else {
          Collect();
          acknowledged_ = sent.size();  // lost
        }
      }
    }
  };
  run(4 * GST_SECOND, true);
  const guint64 before = Stats(element)["target-bitrate"];
  run(30 * GST_SECOND, false);
  const Stats down(element);
  EXPECT_LT(down["target-bitrate"], before / 2);
  EXPECT_LT(down["sent-bitrate"], 400'000U);
  EXPECT_GT(down["feedback-timeouts"], 0U);
  EXPECT_GT(down["frames-dropped"], 1000U);
  // 4 packets each 20 ms for at most twice the 200 ms: a frame that has begun is in no hurry to go.
  EXPECT_LE(down["queued-bytes"], 21U * 4 * 1228);
  EXPECT_GT(down["packets-sent"], 0U);
  run(GST_SECOND, true);
  EXPECT_GT(Stats(element)["target-bitrate"], before / 2);
}

TEST_F(ScreamTx, IsNotMovedByAFloodOfTheSameReport) {
  Start();
  for (guint32 i = 0; i < 20; ++i) {
    PushFrame(i * 900, 2);
    time.Advance(10 * GST_MSECOND);
    Acknowledge();
  }
  const Stats before(element);
  CongestionFeedback old;
  old.blocks.push_back({0x1234, 0, {{true, scream::Ecn::kEct1, Duration{0}}}});
  for (int i = 0; i < 2000; ++i) Feed(old);
  const Stats after(element);
  EXPECT_EQ(after["packets-ce"], before["packets-ce"]);
  EXPECT_EQ(after["packets-acked"], before["packets-acked"]);
  EXPECT_GE(after["target-bitrate"], before["target-bitrate"]);
}

TEST_F(ScreamTx, SendsKeyUnitRequestsToTheStreamThatTheyName) {
  Start();
  Harness second(gst_harness_new_with_element(element, "sink_1", nullptr));
  gst_harness_set_src_caps_str(second.get(), kVideoCaps);
  Rtp r;
  r.ssrc = 0x5678;
  ASSERT_EQ(gst_harness_push(second.get(), NewRtp(r)), GST_FLOW_OK);
  GstStructure* s = gst_structure_new("GstForceKeyUnit", "ssrc", G_TYPE_UINT, 0x5678, nullptr);
  ASSERT_TRUE(gst_harness_push_upstream_event(rtp.get(),
                                              gst_event_new_custom(GST_EVENT_CUSTOM_UPSTREAM, s)));
  const EventPtr event(WaitForUpstream(second.get(), "GstForceKeyUnit"));
  EXPECT_TRUE(event);
  while (EventPtr other{gst_harness_try_pull_upstream_event(rtp.get())})
    EXPECT_FALSE(gst_event_has_name(other.get(), "GstForceKeyUnit"));
}

TEST_F(ScreamTx, ReleasesARequestPadWithPacketsInItsQueue) {
  Start();
  GstPad* pad = gst_element_request_pad_simple(element, "sink_%u");
  ASSERT_TRUE(pad);
  gst_pad_set_active(pad, TRUE);
  gst_element_release_request_pad(element, pad);
  gst_object_unref(pad);
  PushFrame(0, 1);
  const BufferPtr out(gst_harness_pull(rtp.get()));
  EXPECT_TRUE(out);
}

TEST_F(ScreamTx, NotifiesTheEstimatedBitrateOnTheWire) {
  g_object_set(element, "start-bitrate", 3'000'000, nullptr);
  Start();
  PushFrame(0, 1);
  time.Advance(10 * GST_MSECOND);
  guint bps = 0;
  g_object_get(element, "estimated-bitrate", &bps, nullptr);
  EXPECT_EQ(bps, 3'000'000U);
}

TEST_F(ScreamTx, PostsItsStatisticsAtTheInterval) {
  g_object_set(element, "stats-interval", guint64{100 * GST_MSECOND}, nullptr);
  GstBus* bus = gst_bus_new();
  gst_element_set_bus(element, bus);
  Start();
  PushFrame(0, 1);
  for (int i = 0; i < 5; ++i) {
    time.Advance(100 * GST_MSECOND);
    const gst::MessagePtr message(
        gst_bus_timed_pop_filtered(bus, 10 * GST_SECOND, GST_MESSAGE_ELEMENT));
    ASSERT_TRUE(message);
    EXPECT_TRUE(gst_message_has_name(message.get(), "application/x-screamtx-stats"));
  }
  gst_element_set_state(element, GST_STATE_NULL);
  gst_element_set_bus(element, nullptr);
  gst_object_unref(bus);
}

TEST_F(ScreamTx, FallsBackAndSaysSoWhereThePathBleachesEcn) {
  GstBus* bus = gst_bus_new();
  gst_element_set_bus(element, bus);
  Start();
  for (guint32 i = 0; i < 100; ++i) {
    PushFrame(i * 900, 2);
    time.Advance(20 * GST_MSECOND);
    Acknowledge(scream::Ecn::kNotEct);
  }
  Collect();
  EXPECT_EQ(ecns.front(), GST_LIDAR_ECN_ECT1);
  EXPECT_EQ(ecns.back(), GST_LIDAR_ECN_NOT_ECT);
  EXPECT_EQ(Stats(element).Text("ecn-state"), "bleached");
  const gst::MessagePtr message(
      gst_bus_timed_pop_filtered(bus, 10 * GST_SECOND, GST_MESSAGE_ELEMENT));
  ASSERT_TRUE(message);
  EXPECT_TRUE(gst_message_has_name(message.get(), "scream-ecn-state-changed"));
  gst_element_set_state(element, GST_STATE_NULL);
  gst_element_set_bus(element, nullptr);
  gst_object_unref(bus);
}

}  // namespace
}  // namespace lidar::test
