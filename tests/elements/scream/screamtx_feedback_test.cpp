// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of how screamtx handles RTCP: reports, forged reports, and RTCP for other elements.
#include <gst/video/video.h>
#include <gtest/gtest.h>
#include <time.h>

#include <atomic>
#include <optional>

#include "gst/scream/key_request.h"
#include "src/rtcp/sender_report.h"
#include "tests/elements/scream/screamtx_fixture.h"
#include "tests/support/element_bus.h"
#include "tests/support/patience.h"

namespace lidar::test {
namespace {

using gst::PadPtr;
using rtcp::CongestionFeedback;

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
  const auto run = [&](int frames, Ecn ecn) {
    for (int i = 0; i < frames; ++i) {
      PushFrame(static_cast<guint32>(sent.size()) * 900, 8);
      for (int k = 0; k < 5; ++k) {
        time.Advance(5 * GST_MSECOND);
        Acknowledge(ecn);
      }
    }
  };
  run(40, Ecn::kEct1);
  const guint64 free = Stats(element)["target-bitrate"];
  EXPECT_GT(free, 1'200'000U);
  Targets(rtp.get());
  run(40, Ecn::kCe);
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

/// A fixture that sends one packet every 10 ms, and a report after each packet. `arrives` returns
/// what the reports say about the packet with a given sequence number.
class ScreamTxFates : public ScreamTx {
 protected:
  template <class Arrives>
  void Run(int packets, const Arrives& arrives) {
    for (int i = 0; i < packets; ++i) {
      const std::size_t before = sent.size();
      PushFrame(next_seq_ * 900U, 1);
      for (int k = 0; k < 50 && sent.size() == before; ++k) {
        time.Advance(10 * GST_MSECOND);
        Collect();
      }
      Feed(ReportOf(arrives));
      ++reports_;
    }
  }
  template <class Arrives>
  CongestionFeedback ReportOf(const Arrives& arrives) const {
    CongestionFeedback report;
    report.sender_ssrc = 9;
    report.report_timestamp =
        static_cast<std::uint32_t>(gst_util_uint64_scale(time.now(), 65536, GST_SECOND));
    report.blocks.push_back({0x1234, 0, {}});
    for (const Rtp& packet : sent) report.blocks[0].metrics.push_back(arrives(packet.seq));
    return report;
  }
  guint64 reports_ = 0;
};

TEST_F(ScreamTxFates, AreReportedToTheReceiverAsTheyAreShown) {
  g_object_set(element, "sender-report-interval", guint64{GST_SECOND}, nullptr);
  Start();
  Run(60, [](guint16 seq) {
    return rtcp::PacketMetric{seq < 3 || seq > 5, seq == 20 ? Ecn::kCe : Ecn::kEct1, Duration{0}};
  });
  byes.clear();
  time.Advance(GST_SECOND);
  PushFrame(9'000'000, 1);
  Collect();
  ASSERT_EQ(byes.size(), 1U);
  const auto report = rtcp::ParseSenderReport({byes[0].data(), byes[0].size()});
  ASSERT_TRUE(report);
  const Stats stats(element);
  const auto bps = [](DataRate rate) { return static_cast<guint64>(rate.bits_per_second()); };
  EXPECT_EQ(bps(report->target_bitrate), stats["target-bitrate"]);
  EXPECT_EQ(bps(report->estimated_capacity), stats["estimated-capacity"]);
  EXPECT_EQ(bps(report->sent_bitrate), stats["sent-bitrate"]);
  EXPECT_EQ(static_cast<guint64>(report->ref_wnd.bytes()), stats["ref-wnd"]);
  EXPECT_EQ(static_cast<guint64>(report->bytes_in_flight.bytes()), stats["bytes-in-flight"]);
  EXPECT_EQ(static_cast<guint64>(report->rtt.count()) / 1'000, stats["rtt"] / 1'000);
  EXPECT_EQ(static_cast<guint64>(report->queue_delay.count()) / 1'000,
            stats["queue-delay"] / 1'000);
  EXPECT_EQ(report->packets_sent, stats["packets-sent"]);
  EXPECT_EQ(report->packets_lost, 3U);
  EXPECT_EQ(report->packets_ce, 1U);
  EXPECT_EQ(report->packets_dropped, 0U);
}

TEST_F(ScreamTxFates, AreCountedEachByItsName) {
  const rtcp::PacketMetric arrived{true, Ecn::kEct1, Duration{0}};
  const rtcp::PacketMetric marked{true, Ecn::kCe, Duration{0}};
  const auto arrives = [&](guint16 seq) {
    if (seq >= 3 && seq < 6) return rtcp::PacketMetric{};
    return seq == 20 || seq == 22 ? marked : arrived;
  };
  Start();
  Run(60, arrives);
  EXPECT_EQ(Stats(element)["packets-lost"], 3U);
  EXPECT_EQ(Stats(element)["packets-late"], 0U);
  // The lost packet 4 arrives after all.
  Run(1, [&](guint16 seq) { return seq == 4 ? arrived : arrives(seq); });
  // A report with a block about the packets of another sender, malformed RTCP, and a datagram that
  // is not RTP.
  CongestionFeedback report = ReportOf(arrives);
  report.blocks.push_back({0x9999, 0, {arrived}});
  Feed(report);
  for (int i = 0; i < 4; ++i)
    gst_harness_push(rtcp.get(), FromBytes({0x8b, 205, 0, 1, 0, 0, 0, 1}));
  ASSERT_EQ(gst_harness_push(rtp.get(), FromBytes({1, 2, 3})), GST_FLOW_OK);
  const Stats stats(element);
  EXPECT_EQ(stats["packets-sent"], 61U);
  EXPECT_EQ(stats["packets-acked"], 61U - 2);
  EXPECT_EQ(stats["packets-lost"], 3U);
  EXPECT_EQ(stats["packets-late"], 1U);
  EXPECT_EQ(stats["packets-ce"], 2U);
  EXPECT_EQ(stats["packets-dropped"], 0U);
  EXPECT_EQ(stats["feedback-accepted"], reports_ - 3) << "those of the lost had no news";
  EXPECT_EQ(stats["feedback-foreign-blocks"], 1U);
  EXPECT_EQ(stats["rtcp-malformed"], 4U);
  const Stats stream = stats.Of("streams", 0);
  EXPECT_EQ(stream["ssrc"], 0x1234U);
  EXPECT_EQ(stream["packets-queued"], 61U);
  EXPECT_EQ(stream["packets-sent"], 61U);
  EXPECT_EQ(stream["packets-lost"], 3U);
  EXPECT_EQ(stream["packets-ce"], 2U);
  EXPECT_EQ(stream["malformed"], 1U);
  EXPECT_EQ(stream["bytes-sent"], stats["bytes-sent"]);
}

TEST_F(ScreamTx, ShowsThePadAndTheQueueOfEachStream) {
  g_object_set(element, "min-bitrate", 111'111, "start-bitrate", 222'222, "max-bitrate", 333'333,
               nullptr);
  Start();
  Harness second(gst_harness_new_with_element(element, "sink_7", nullptr));
  gst_harness_set_src_caps_str(second.get(), kVideoCaps);
  const gst::PadPtr pad(gst_element_get_static_pad(element, "sink_7"));
  g_object_set(pad.get(), "max-bitrate", 300'000U, nullptr);
  PushFrame(0, 100);
  time.Advance(50 * GST_MSECOND);
  const Stats stats(element), first = stats.Of("streams", 0), other = stats.Of("streams", 1);
  EXPECT_EQ(first.Text("pad"), "sink_0");
  EXPECT_EQ(other.Text("pad"), "sink_7");
  EXPECT_EQ(first["min-bitrate"], 111'111U);
  EXPECT_EQ(first["max-bitrate"], 333'333U);
  EXPECT_EQ(other["max-bitrate"], 300'000U);
  EXPECT_EQ(first["target-bitrate"] + other["target-bitrate"], stats["target-bitrate"]);
  EXPECT_NEAR(
      static_cast<double>(first["encoder-bitrate"]) / static_cast<double>(first["target-bitrate"]),
      1188.0 / 1228, 1e-3);
  EXPECT_EQ(first["queued-bytes"], (100 - first["packets-sent"]) * 1228);
  EXPECT_EQ(stats["queued-bytes"], first["queued-bytes"]);
  EXPECT_EQ(first["sender-queue-delay"], 50 * GST_MSECOND);
  EXPECT_EQ(stats["sender-queue-delay"], 50 * GST_MSECOND);
  EXPECT_EQ(other["sender-queue-delay"] + other["queued-bytes"] + other["packets-queued"], 0U);
  EXPECT_EQ(stats["bytes-sent"], stats["packets-sent"] * 1228);
}

TEST_F(ScreamTx, TellsTheEncoderTheRoundTripAndTheQueueThatItShows) {
  Start();
  // In the first 30 round trips there is no queue, and they take 40 ms. In the next 30 round trips
  // a queue adds 30 ms.
  for (const guint64 round_trip_ms : {40U, 70U})
    for (guint32 i = 0; i < 30; ++i) {
      PushFrame(next_seq_ * 900U, 1);
      Collect();
      time.Advance(round_trip_ms * GST_MSECOND);
      Acknowledge();
    }
  const GstLidarTargetBitrate told = NextTarget(rtp.get());
  const Stats stats(element);
  EXPECT_EQ(told.rtt, stats["rtt"]);
  EXPECT_EQ(told.queue_delay, stats["queue-delay"]);
  EXPECT_NEAR(static_cast<double>(told.rtt), 70e6, 5e6);
  EXPECT_NEAR(static_cast<double>(told.queue_delay), 30e6, 5e6);
  EXPECT_NEAR(static_cast<double>(stats["min-rtt"]), 40e6, 5e6);
}

constexpr const char* kLidarCaps =
    "application/x-rtp,media=(string)application,clock-rate=90000,"
    "encoding-name=(string)X-LIDAR-DRACO,payload=96";

TEST_F(ScreamTx, TellsThePayloaderOfLidarWhatHasArrived) {
  Start(kLidarCaps);
  PushFrame(0, 4);
  guint16 last = 0;
  for (int i = 0; i < 100 && last < 3; ++i) {
    time.Advance(10 * GST_MSECOND);
    const std::size_t before = acknowledged_;
    Acknowledge();
    if (acknowledged_ == before) continue;
    const EventPtr event(WaitForUpstream(rtp.get(), "packets-received"));
    GstLidarPacketsReceived received{};
    ASSERT_TRUE(event && gst_lidar_event_parse_packets_received(event.get(), &received));
    EXPECT_EQ(received.ssrc, 0x1234U);
    EXPECT_EQ(received.receiver, 9U);
    ASSERT_EQ(received.count, 1U);
    EXPECT_EQ(received.ranges[0].first, before);
    last = received.ranges[0].last;
  }
  EXPECT_EQ(last, 3U);
}

TEST_F(ScreamTx, TellsThePayloaderOfNoPacketThatHasNotArrived) {
  Start(kLidarCaps);
  PushFrame(0, 4);
  for (int i = 0; i < 100 && sent.size() < 4; ++i) {
    time.Advance(10 * GST_MSECOND);
    Collect();
  }
  ASSERT_EQ(sent.size(), 4U);
  CongestionFeedback report;
  report.sender_ssrc = 9;
  report.report_timestamp = 65536 * 1001;
  const rtcp::PacketMetric arrived{true, Ecn::kEct1, Duration{0}};
  report.blocks.push_back({0x1234, 0, {arrived, {}, arrived, arrived}});
  Feed(report);
  const EventPtr event(WaitForUpstream(rtp.get(), "packets-received"));
  GstLidarPacketsReceived received{};
  ASSERT_TRUE(event && gst_lidar_event_parse_packets_received(event.get(), &received));
  ASSERT_EQ(received.count, 2U);
  EXPECT_EQ(received.ranges[0].last, 0);
  EXPECT_EQ(received.ranges[1].first, 2);
  EXPECT_EQ(received.ranges[1].last, 3);
}

TEST_F(ScreamTxFates, OfMoreRangesThanAReceiptHoldsAreToldFromTheFirstOn) {
  g_object_set(element, "min-bitrate", 10'000'000, "start-bitrate", 10'000'000, nullptr);
  Start(kLidarCaps);
  Run(2 * GST_LIDAR_MAX_RECEIVED + 8, [](guint16 seq) {
    return rtcp::PacketMetric{seq % 2 == 0, Ecn::kEct1, Duration{0}};
  });
  GstLidarPacketsReceived received{};
  while (received.count < GST_LIDAR_MAX_RECEIVED) {
    const EventPtr event(WaitForUpstream(rtp.get(), "packets-received"));
    ASSERT_TRUE(event && gst_lidar_event_parse_packets_received(event.get(), &received));
  }
  for (guint i = 0; i < received.count; ++i) {
    EXPECT_EQ(received.ranges[i].first, 2 * i);
    EXPECT_EQ(received.ranges[i].last, 2 * i);
  }
}

TEST_F(ScreamTx, TakesNoReceiptsFromReportsThatNameNoReceiver) {
  Start(kLidarCaps);
  // Transport-wide feedback does not name a receiver, and packets that it reports may still be
  // dropped afterwards. Therefore such feedback must not cause receipts.
  for (const guint32 ssrc : {0U, 9U}) {
    receiver = ssrc;
    const std::size_t before = acknowledged_;
    PushFrame(ssrc * 9000, 2);
    for (int i = 0; i < 100 && acknowledged_ < before + 2; ++i) {
      time.Advance(10 * GST_MSECOND);
      Acknowledge();
    }
    ASSERT_EQ(acknowledged_, before + 2);
  }
  const EventPtr event(WaitForUpstream(rtp.get(), "packets-received"));
  GstLidarPacketsReceived received{};
  ASSERT_TRUE(event && gst_lidar_event_parse_packets_received(event.get(), &received));
  EXPECT_EQ(received.receiver, 9U);
}

TEST_F(ScreamTx, LeavesTheReceiptsOutOfOtherMedia) {
  Start();
  PushFrame(0, 4);
  for (int i = 0; i < 10; ++i) {
    time.Advance(50 * GST_MSECOND);
    Acknowledge();
  }
  EXPECT_EQ(NamesUpstream(rtp.get()).count("packets-received"), 0U);
}

TEST_F(ScreamTx, GivesReceiptsByThePresentCaps) {
  Start(kLidarCaps);
  gst_harness_set_src_caps_str(rtp.get(), kRtpCaps);
  const auto run = [&] {
    PushFrame(next_seq_ * 900U, 2);
    for (int i = 0; i < 10; ++i) {
      time.Advance(50 * GST_MSECOND);
      Acknowledge();
    }
    return NamesUpstream(rtp.get()).count("packets-received");
  };
  EXPECT_EQ(run(), 0U);
  gst_harness_set_src_caps_str(rtp.get(), kLidarCaps);
  EXPECT_GE(run(), 1U);
}

TEST_F(ScreamTx, AsksTheEncoderOfLidarForAKeyUnitWhereAReceiverDoes) {
  StartAsLast(kLidarCaps);
  PushFrame(0, 1);
  Collect();
  const auto request = gst::BuildKeyRequest(9, 0x1234);
  ASSERT_EQ(gst_harness_push(rtcp.get(), FromBytes(request)), GST_FLOW_OK);
  EXPECT_TRUE(EventPtr(WaitForUpstream(rtp.get(), "GstForceKeyUnit")));
}

TEST_F(ScreamTx, NumbersItsRequestsForKeyUnits) {
  StartAsLast(kLidarCaps);
  PushFrame(0, 1);
  Collect();
  for (guint expected = 1; expected <= 3; ++expected) {
    const auto request = gst::BuildKeyRequest(9, 0x1234);
    ASSERT_EQ(gst_harness_push(rtcp.get(), FromBytes(request)), GST_FLOW_OK);
    const EventPtr event(WaitForUpstream(rtp.get(), "GstForceKeyUnit"));
    ASSERT_TRUE(event);
    guint count = 0;
    gboolean all_headers = FALSE;
    GstClockTime running_time = 0;
    ASSERT_TRUE(gst_video_event_parse_upstream_force_key_unit(event.get(), &running_time,
                                                              &all_headers, &count));
    EXPECT_EQ(count, expected);
    EXPECT_TRUE(all_headers);
    EXPECT_EQ(running_time, GST_CLOCK_TIME_NONE) << "at once";
    time.Advance(600 * GST_MSECOND);
  }
}

TEST_F(ScreamTx, LeavesKeyUnitsOfVideoToWhoManagesItsSession) {
  StartAsLast(kVideoCaps);
  PushFrame(0, 1);
  Collect();
  const auto request = gst::BuildKeyRequest(9, 0x1234);
  ASSERT_EQ(gst_harness_push(rtcp.get(), FromBytes(request)), GST_FLOW_OK);
  EXPECT_EQ(NamesUpstream(rtp.get()).count("GstForceKeyUnit"), 0U);
}

TEST_F(ScreamTx, LeavesKeyRequestsToWhoTakesTheRestOfTheRtcp) {
  Start(kLidarCaps);
  PushFrame(0, 1);
  Collect();
  const auto request = gst::BuildKeyRequest(9, 0x1234);
  ASSERT_EQ(gst_harness_push(rtcp.get(), FromBytes(request)), GST_FLOW_OK);
  const BufferPtr passed(gst_harness_pull(rtcp.get()));
  EXPECT_EQ(ToBytes(passed.get()), request);
  EXPECT_EQ(NamesUpstream(rtp.get()).count("GstForceKeyUnit"), 0U);
}

TEST_F(ScreamTx, SleepsWhileAKeyUnitHasToWait) {
  StartAsLast(kLidarCaps);
  PushFrame(0, 1);
  Collect();
  const auto request = gst::BuildKeyRequest(9, 0x1234);
  ASSERT_EQ(gst_harness_push(rtcp.get(), FromBytes(request)), GST_FLOW_OK);
  ASSERT_TRUE(EventPtr(WaitForUpstream(rtp.get(), "GstForceKeyUnit")));
  ASSERT_EQ(gst_harness_push(rtcp.get(), FromBytes(request)), GST_FLOW_OK);
  // The test's clock does not advance, so the second request has to wait. A thread checks the
  // request every 200 ms, and must sleep in between.
  const auto processor_time = [] {
    timespec spent{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &spent);
    return spent.tv_sec * G_USEC_PER_SEC + spent.tv_nsec / 1000;
  };
  const gint64 before = processor_time();
  g_usleep(G_USEC_PER_SEC / 2);
  EXPECT_LT(processor_time() - before, G_USEC_PER_SEC / 50);
  time.Advance(600 * GST_MSECOND);
  EXPECT_TRUE(EventPtr(WaitForUpstream(rtp.get(), "GstForceKeyUnit")));
}

TEST_F(ScreamTx, PassesForeignRtcpAndKeepsItsOwn) {
  Start();
  PushFrame(0, 1);
  Collect();
  std::vector<std::uint8_t> receiver_report{0x80, 201, 0, 1, 0, 0, 0, 5};
  CongestionFeedback ours;
  ours.blocks.push_back({0x1234, 0, {{true, Ecn::kEct1, Duration{0}}}});
  const auto ccfb = rtcp::BuildCcfb(ours);
  auto compound = receiver_report;
  compound.insert(compound.end(), ccfb.begin(), ccfb.end());
  // If there is an rtpbin downstream, it needs the buffer's time to compute round trips, and the
  // buffer's address to identify the sender.
  GstBuffer* datagram = FromBytes(compound);
  GST_BUFFER_PTS(datagram) = 7 * GST_SECOND;
  const std::unique_ptr<GSocketAddress, gst::GObjectUnref> peer(
      g_inet_socket_address_new_from_string("192.0.2.1", 5005));
  gst_buffer_add_net_address_meta(datagram, peer.get());
  ASSERT_EQ(gst_harness_push(rtcp.get(), datagram), GST_FLOW_OK);
  const BufferPtr out(gst_harness_pull(rtcp.get()));
  EXPECT_EQ(ToBytes(out.get()), receiver_report);
  EXPECT_EQ(GST_BUFFER_PTS(out.get()), 7 * GST_SECOND);
  const GstNetAddressMeta* meta = gst_buffer_get_net_address_meta(out.get());
  ASSERT_TRUE(meta);
  EXPECT_EQ(meta->addr, peer.get());

  ours.blocks[0].ssrc = 0x9999;  // SSRC of another sender downstream
  const auto theirs = rtcp::BuildCcfb(ours);
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
  EXPECT_EQ(Stats(element)["rtcp-malformed"], 1U);
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
  rtcp::SsrcReport block{0x1234, 30000, {}};
  for (int i = 0; i < 50; ++i) block.metrics.push_back({true, Ecn::kCe, Duration{0}});
  lie.blocks.push_back(block);
  for (int i = 0; i < 20; ++i) Feed(lie);
  const Stats after(element);
  EXPECT_EQ(after["target-bitrate"], before);
  EXPECT_EQ(after["packets-ce"], 0U);
  EXPECT_EQ(after["feedback-ignored"], 20U);
}

TEST_F(ScreamTx, TakesLiesForNoSignOfAReceiver) {
  const ElementBus bus(element);
  Start();
  CongestionFeedback lie;
  lie.blocks.push_back({0x1234, 30000, {{true, Ecn::kCe, Duration{0}}}});
  for (guint32 i = 0; i < 50; ++i) {
    PushFrame(i * 900, 1);
    Feed(lie);
    time.Advance(50 * GST_MSECOND);
  }
  EXPECT_TRUE(bus.Wait(GST_MESSAGE_WARNING));
  gst_element_set_state(element, GST_STATE_NULL);
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
  old.blocks.push_back({0x1234, 0, {{true, Ecn::kEct1, Duration{0}}}});
  for (int i = 0; i < 2000; ++i) Feed(old);
  const Stats after(element);
  EXPECT_EQ(after["packets-ce"], before["packets-ce"]);
  EXPECT_EQ(after["packets-acked"], before["packets-acked"]);
  EXPECT_GE(after["target-bitrate"], before["target-bitrate"]);
}

TEST_F(ScreamTx, FallsBackAndSaysSoWhereThePathBleachesEcn) {
  const ElementBus bus(element);
  Start();
  std::string state = Stats(element).Text("ecn-state");
  for (guint32 i = 0; i < 100; ++i) {
    PushFrame(i * 900, 2);
    time.Advance(20 * GST_MSECOND);
    Acknowledge(Ecn::kNotEct);
  }
  Collect();
  EXPECT_EQ(ecns.front(), GST_LIDAR_ECN_ECT1);
  EXPECT_EQ(ecns.back(), GST_LIDAR_ECN_NOT_ECT);
  EXPECT_EQ(Stats(element).Text("ecn-state"), "bleached");
  while (state != "bleached") {
    const gst::MessagePtr message = bus.Wait(GST_MESSAGE_ELEMENT);
    ASSERT_TRUE(message);
    EXPECT_TRUE(gst_message_has_name(message.get(), "scream-ecn-state-changed"));
    const GstStructure* told = gst_message_get_structure(message.get());
    EXPECT_STREQ(gst_structure_get_string(told, "previous"), state.c_str());
    ASSERT_STRNE(gst_structure_get_string(told, "state"), state.c_str());
    state = gst_structure_get_string(told, "state");
  }
  gst_element_set_state(element, GST_STATE_NULL);
}

TEST_F(ScreamTx, SaysOnceThatNobodyAnswersAndEachTimeThatSomebodyDoesAgain) {
  const ElementBus bus(element);
  Start();
  const auto run = [&](int frames, bool answer) {
    for (int i = 0; i < frames; ++i) {
      PushFrame(static_cast<guint32>(next_seq_) * 900, 1);
      time.Advance(50 * GST_MSECOND);
      if (answer) Acknowledge();
    }
  };
  const auto next = [&](GstClockTime timeout = kPatience_ns) -> gst::MessagePtr {
    for (;;) {
      gst::MessagePtr message = bus.Wait(GST_MESSAGE_ELEMENT | GST_MESSAGE_WARNING, timeout);
      if (!message || !gst_message_has_name(message.get(), "scream-ecn-state-changed"))
        return message;
    }
  };
  const auto tells = [&](const gst::MessagePtr& m, gboolean wanted) {
    gboolean present = FALSE;
    return m && gst_message_has_name(m.get(), "scream-feedback-state-changed") &&
           gst_structure_get_boolean(gst_message_get_structure(m.get()), "present", &present) &&
           present == wanted;
  };
  run(38, false);
  EXPECT_FALSE(next(300 * GST_MSECOND));
  run(10, false);  // together longer than 2 s
  gst::MessagePtr message = next();
  ASSERT_TRUE(message);
  EXPECT_EQ(GST_MESSAGE_TYPE(message.get()), GST_MESSAGE_WARNING);
  EXPECT_TRUE(tells(next(), FALSE));
  Collect();
  // Acknowledge() leaves out the packets so far, because some between them were dropped.
  acknowledged_ = sent.size();
  run(40, true);
  EXPECT_TRUE(tells(next(), TRUE));
  run(60, false);
  EXPECT_TRUE(tells(next(), FALSE));  // there is no second warning
  EXPECT_FALSE(next(300 * GST_MSECOND));
  gst_element_set_state(element, GST_STATE_READY);
  gst_element_set_state(element, GST_STATE_PLAYING);
  gst_harness_play(rtp.get());
  run(38, false);
  EXPECT_FALSE(next(300 * GST_MSECOND));
  run(10, false);  // the next message is the first of this run
  message = next();
  ASSERT_TRUE(message);
  EXPECT_EQ(GST_MESSAGE_TYPE(message.get()), GST_MESSAGE_WARNING);
  gst_element_set_state(element, GST_STATE_NULL);
}

/// A fixture that streams for some time, and counts the warnings that no receiver answered.
class ScreamTxEnds : public ScreamTx {
 protected:
  void TearDown() override {
    gst_element_set_state(element, GST_STATE_NULL);
    bus_.reset();
    ScreamTx::TearDown();
  }
  /// Streams for `length`, with feedback if `answered` is true. Returns the number of warnings
  /// before EOS.
  int WarningsOf(GstClockTime length, bool answered) {
    Start();
    for (GstClockTime at = 0; at < length; at += 10 * GST_MSECOND) {
      PushFrame(next_seq_ * 900U, 1);
      time.Advance(10 * GST_MSECOND);
      if (answered) Acknowledge();
    }
    const PadPtr src(gst_element_get_static_pad(element, "src"));
    gst_pad_add_probe(
        src.get(), GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM,
        [](GstPad*, GstPadProbeInfo* info, gpointer data) {
          auto* self = static_cast<ScreamTxEnds*>(data);
          if (GST_EVENT_TYPE(info->data) == GST_EVENT_EOS) self->CountWarnings();
          return GST_PAD_PROBE_OK;
        },
        this, nullptr);
    EXPECT_TRUE(gst_harness_push_event(rtp.get(), gst_event_new_eos()));
    for (int i = 0; i < 100 && !ended_; ++i) time.Advance(10 * GST_MSECOND);
    EXPECT_TRUE(ended_);
    return warnings_;
  }
  void CountWarnings() {
    while (const gst::MessagePtr message = bus_->Pop(GST_MESSAGE_WARNING)) {
      const std::string text = MessageText(message.get());
      ++warnings_;
      EXPECT_NE(text.find("No feedback until the stream ended"), std::string::npos) << text;
      EXPECT_NE(MessageDetails(message.get()).find("Check host and port"), std::string::npos);
    }
    ended_ = true;
  }

  std::optional<ElementBus> bus_{element};
  std::atomic<bool> ended_{false};
  int warnings_ = 0;
};

TEST_F(ScreamTxEnds, UnheardWithAWarningBeforeTheEnd) {
  EXPECT_EQ(WarningsOf(500 * GST_MSECOND, false), 1);
  EXPECT_EQ(Stats(element)["feedback-accepted"], 0U);
}
TEST_F(ScreamTxEnds, HeardWithoutAWarning) { EXPECT_EQ(WarningsOf(500 * GST_MSECOND, true), 0); }
TEST_F(ScreamTxEnds, TooSoonForAnAnswerWithoutAWarning) {
  EXPECT_EQ(WarningsOf(20 * GST_MSECOND, false), 0);
}

TEST_F(ScreamTx, NamesWhereNobodyAnswersThoughElementsStandBeforeTheSink) {
  const ElementBus bus(element);
  rtp.reset(gst_harness_new_with_element(element, "sink_0", nullptr));
  const gst::ElementPtr first(gst_element_factory_make("identity", nullptr));
  const gst::ElementPtr second(gst_element_factory_make("identity", nullptr));
  const gst::ElementPtr sink(gst_element_factory_make("ecnudpsink", nullptr));
  g_object_set(sink.get(), "host", "127.0.0.1", "port", 9, "sync", FALSE, "async", FALSE, nullptr);
  ASSERT_TRUE(gst_element_link_pads(element, "src", first.get(), "sink"));
  ASSERT_TRUE(gst_element_link_many(first.get(), second.get(), sink.get(), nullptr));
  for (const auto* e : {&sink, &second, &first}) gst_element_set_state(e->get(), GST_STATE_PLAYING);
  gst_harness_set_src_caps_str(rtp.get(), kRtpCaps);
  for (int i = 0; i < 50; ++i) {
    PushFrame(static_cast<guint32>(next_seq_) * 900, 1);
    time.Advance(50 * GST_MSECOND);
  }
  std::string text;
  while (text.find("No feedback") == std::string::npos) {
    const gst::MessagePtr warning = bus.Wait(GST_MESSAGE_WARNING);
    ASSERT_TRUE(warning);
    text = MessageText(warning.get());
  }
  EXPECT_EQ(text.find("No feedback from 127.0.0.1:9 for 2 s"), 0U) << text;
  gst_element_set_state(element, GST_STATE_NULL);
  for (const auto* e : {&sink, &second, &first}) gst_element_set_state(e->get(), GST_STATE_NULL);
}

TEST_F(ScreamTx, TestsThePathAnewWhenTheReceiverHasMoved) {
  Start();
  const auto run = [&](const char* host, Ecn ecn) {
    from.reset(g_inet_socket_address_new_from_string(host, 5004));
    for (guint32 i = 0; i < 60; ++i) {
      PushFrame(static_cast<guint32>(sent.size()) * 900, 2);
      time.Advance(20 * GST_MSECOND);
      Acknowledge(ecn);
    }
    Collect();
  };
  run("192.0.2.1", Ecn::kNotEct);
  EXPECT_EQ(Stats(element).Text("ecn-state"), "bleached");
  time.Advance(600 * GST_MSECOND);
  run("192.0.2.2", Ecn::kEct1);
  EXPECT_EQ(Stats(element).Text("ecn-state"), "capable");
  EXPECT_EQ(ecns.back(), GST_LIDAR_ECN_ECT1);
}

TEST_F(ScreamTx, TestsThePathAnewWhereTheApplicationSaysSo) {
  Start();
  const auto run = [&](Ecn ecn) {
    for (guint32 i = 0; i < 60; ++i) {
      PushFrame(static_cast<guint32>(sent.size()) * 900, 2);
      time.Advance(20 * GST_MSECOND);
      Acknowledge(ecn);
    }
  };
  run(Ecn::kNotEct);
  EXPECT_EQ(Stats(element).Text("ecn-state"), "bleached");
  g_signal_emit_by_name(element, "route-changed");
  run(Ecn::kEct1);
  EXPECT_EQ(Stats(element).Text("ecn-state"), "capable");
}

TEST_F(ScreamTx, KeepsThePathWhileItsReceiverIsThere) {
  Start();
  std::unique_ptr<GSocketAddress, gst::GObjectUnref> other(
      g_inet_socket_address_new_from_string("192.0.2.2", 5004));
  from.reset(g_inet_socket_address_new_from_string("192.0.2.1", 5004));
  for (guint32 i = 0; i < 60; ++i) {
    PushFrame(i * 1800, 2);
    time.Advance(20 * GST_MSECOND);
    Acknowledge(Ecn::kNotEct);
    if (i % 5 == 0) from.swap(other);
  }
  EXPECT_EQ(Stats(element).Text("ecn-state"), "bleached");
}

TEST_F(ScreamTx, AReceiverElsewhereInTheNextRunIsNoNewPath) {
  Start();
  for (const char* host : {"192.0.2.1", "192.0.2.2"}) {
    from.reset(g_inet_socket_address_new_from_string(host, 5004));
    PushFrame(next_seq_, 2);
    time.Advance(20 * GST_MSECOND);
    Acknowledge();
    EXPECT_GT(Stats(element)["rtt"], 0U) << host;
    time.Advance(600 * GST_MSECOND);
    Restart();
  }
}

}  // namespace
}  // namespace lidar::test
