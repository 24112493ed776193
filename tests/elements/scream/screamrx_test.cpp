// SPDX-License-Identifier: LGPL-2.1-or-later
// screamrx under a test clock: what it reports, to whom, and whom it believes.
#include <gtest/gtest.h>

#include "gst/scream/key_request.h"
#include "gst/scream/rtp_packet.h"
#include "src/rtp/ntp_time.h"
#include "src/scream/feedback/sender_report.h"
#include "tests/elements/scream/rtp_support.h"

namespace lidar::test {
namespace {

using gst::CapsPtr;
using scream::CongestionFeedback;

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
  GstFlowReturn PushBye(std::vector<guint32> ssrcs, const char* host = nullptr) {
    GstBuffer* buffer = FromBytes(gst::BuildBye(ssrcs));
    if (host != nullptr) SetSource(buffer, host, 5000);
    return gst_harness_push(rtp.get(), buffer);
  }
  GstFlowReturn PushReport(const scream::SenderReport& report, const char* host = "10.0.0.1") {
    GstBuffer* buffer = FromBytes(scream::BuildSenderReport(report));
    SetSource(buffer, host, 5000);
    return gst_harness_push(rtp.get(), buffer);
  }
  CongestionFeedback Report(BufferPtr* raw = nullptr) {
    BufferPtr buffer(gst_harness_pull(rtcp.get()));
    if (!buffer) return {};
    const auto bytes = ToBytes(buffer.get());
    const auto report = scream::CcfbParser().Parse({bytes.data(), bytes.size()});
    if (raw != nullptr) *raw = std::move(buffer);
    EXPECT_TRUE(report);
    return report.value_or(CongestionFeedback{});
  }
  /// The first packet of all is reported at once; those behind it show the rules.
  void PushFirst(guint16 seq) {
    Rtp r;
    r.seq = seq;
    ASSERT_EQ(Push(r), GST_FLOW_OK);
    Report();
    time.Settle();
  }
  guint Passed() { return gst_harness_buffers_received(rtp.get()); }
};

TEST_F(ScreamRx, CarriesTheWishForAKeyUnitToTheSender) {
  g_object_set(element, "ssrc", 77, nullptr);
  Start();
  PushFirst(1);
  GstStructure* wish = gst_structure_new_empty("GstForceKeyUnit");
  ASSERT_TRUE(gst_harness_push_upstream_event(
      rtp.get(), gst_event_new_custom(GST_EVENT_CUSTOM_UPSTREAM, wish)));
  const BufferPtr packet(gst_harness_pull(rtcp.get()));
  ASSERT_TRUE(packet);
  EXPECT_EQ(ToBytes(packet.get()), gst::BuildKeyRequest(77, 0x1234));
  EXPECT_EQ(Passed(), 1U);
}

TEST_F(ScreamRx, ReportsEachPacketOfAFrameAtItsMarker) {
  g_object_set(element, "ssrc", 77, nullptr);
  Start();
  const GstLidarEcn ecns[] = {GST_LIDAR_ECN_ECT1, GST_LIDAR_ECN_ECT1, GST_LIDAR_ECN_ECT1,
                              GST_LIDAR_ECN_CE};
  PushFirst(65534);
  for (guint16 i = 1; i < 4; ++i) {
    Rtp r;
    r.seq = static_cast<guint16>(65534 + i);  // over the wrap
    r.marker = i == 3;
    ASSERT_EQ(Push(r, ecns[i]), GST_FLOW_OK);
  }
  const CongestionFeedback report = Report();
  EXPECT_EQ(report.sender_ssrc, 77U);
  ASSERT_EQ(report.blocks.size(), 1U);
  EXPECT_EQ(report.blocks[0].ssrc, 0x1234U);
  EXPECT_EQ(report.blocks[0].begin_seq, 65534);
  ASSERT_EQ(report.blocks[0].metrics.size(), 4U);
  for (guint i = 0; i < 4; ++i) {
    EXPECT_TRUE(report.blocks[0].metrics[i].received);
    EXPECT_EQ(static_cast<int>(report.blocks[0].metrics[i].ecn), ecns[i]);
  }
  EXPECT_EQ(Passed(), 4U);
}

TEST_F(ScreamRx, ReportsALonePacketAfterTheInterval) {
  g_object_set(element, "feedback-interval", guint64{30 * GST_MSECOND}, nullptr);
  Start();
  PushFirst(0);
  Rtp r;
  r.seq = 1;
  ASSERT_EQ(Push(r), GST_FLOW_OK);
  time.Settle();
  time.Advance(29 * GST_MSECOND);
  EXPECT_EQ(gst_harness_buffers_received(rtcp.get()), 1U);
  time.Advance(GST_MSECOND);
  const CongestionFeedback report = Report();
  ASSERT_EQ(report.blocks.size(), 1U);
  const auto offset = report.blocks[0].metrics.back().arrival_offset;
  ASSERT_TRUE(offset);
  EXPECT_NEAR(Milliseconds(*offset), 30, 1.0);
}

TEST_F(ScreamRx, CountsInTheKernelsArrivalTime) {
  Start();
  Rtp r;
  r.marker = true;
  GstBuffer* buffer = NewRtp(r);
  const auto unix_now = static_cast<GstClockTime>(g_get_real_time()) * GST_USECOND;
  gst_lidar_buffer_set_ecn(buffer, GST_LIDAR_ECN_ECT1, unix_now - 500 * GST_MSECOND);
  ASSERT_EQ(gst_harness_push(rtp.get(), buffer), GST_FLOW_OK);
  const auto offset = Report().blocks.at(0).metrics.at(0).arrival_offset;
  ASSERT_TRUE(offset);
  EXPECT_GE(Milliseconds(*offset), 499);
  EXPECT_LT(Milliseconds(*offset), 900);
}

TEST_F(ScreamRx, AClockThatWasSetIsNoArrivalTime) {
  Start();
  guint16 seq = 0;
  for (const gint64 set_s : {-3600, 3600, -2, 2}) {
    Rtp r;
    r.seq = seq++;
    r.marker = true;
    GstBuffer* buffer = NewRtp(r);
    const gint64 arrival = g_get_real_time() * 1000 + set_s * gint64{GST_SECOND};
    gst_lidar_buffer_set_ecn(buffer, GST_LIDAR_ECN_ECT1, static_cast<GstClockTime>(arrival));
    ASSERT_EQ(gst_harness_push(rtp.get(), buffer), GST_FLOW_OK);
    const auto offset = Report().blocks.at(0).metrics.back().arrival_offset;
    ASSERT_TRUE(offset) << set_s;
    EXPECT_LT(Milliseconds(*offset), 100) << set_s;  // the clock of the test stands still
    time.Advance(20 * GST_MSECOND);
  }
}

TEST_F(ScreamRx, AnswersTheLatchedPeer) {
  Start();
  Rtp r;
  r.marker = true;
  ASSERT_EQ(Push(r, GST_LIDAR_ECN_ECT1, "10.0.0.1", 4711), GST_FLOW_OK);
  BufferPtr raw;
  Report(&raw);
  const GstNetAddressMeta* meta = gst_buffer_get_net_address_meta(raw.get());
  ASSERT_TRUE(meta != nullptr);
  EXPECT_EQ(g_inet_socket_address_get_port(G_INET_SOCKET_ADDRESS(meta->addr)), 4711);
}

TEST_F(ScreamRx, DropsWhatAStrangerSends) {
  Start();
  Rtp r;
  for (guint16 seq = 0; seq < 29; ++seq) {
    r.seq = seq;
    ASSERT_EQ(Push(r, GST_LIDAR_ECN_ECT1, seq < 10 ? "10.0.0.1" : "10.0.0.2"), GST_FLOW_OK);
  }
  EXPECT_EQ(Passed(), 10U);
  EXPECT_EQ(Stats(element)["packets-foreign"], 19U);
  EXPECT_EQ(Stats(element)["packets-received"], 10U);
}

TEST_F(ScreamRx, FollowsASenderThatComesBackFromAnotherAddress) {
  Start();
  Rtp r;
  ASSERT_EQ(Push(r, GST_LIDAR_ECN_ECT1, "10.0.0.1"), GST_FLOW_OK);
  time.Settle();
  time.Advance(600 * GST_MSECOND);
  for (guint16 seq = 1; seq <= 10; ++seq) {
    r.seq = seq;
    ASSERT_EQ(Push(r, GST_LIDAR_ECN_ECT1, "10.0.0.2"), GST_FLOW_OK);
  }
  EXPECT_EQ(Passed(), 7U);  // four of the new address had to prove themselves
  EXPECT_EQ(Stats(element)["peer-moves"], 1U);
  r.seq = 11;
  r.marker = true;
  ASSERT_EQ(Push(r, GST_LIDAR_ECN_ECT1, "10.0.0.2"), GST_FLOW_OK);
  scream::SsrcReport last;
  do {
    const CongestionFeedback report = Report();
    ASSERT_EQ(report.blocks.size(), 1U);
    last = report.blocks[0];
  } while (last.begin_seq + last.metrics.size() <= 11);
  EXPECT_EQ(last.begin_seq, 5);  // what the old address sent is none of the new one's business
}

TEST_F(ScreamRx, BelievesTheSenderWhoseSlicesAreWholeOverOneWhoSendsOften) {
  Start();
  gst_harness_set_src_caps_str(rtp.get(),
                               "application/x-rtp, media=(string)application, payload=(int)96, "
                               "clock-rate=(int)90000, encoding-name=(string)X-LIDAR-DRACO");
  Rtp r;
  for (guint16 seq = 0; seq < 200; ++seq) {
    r.seq = seq;
    ASSERT_EQ(Push(r, GST_LIDAR_ECN_ECT1, "10.0.0.9"), GST_FLOW_OK);
  }
  r.ssrc = 0x5678;
  r.payload = test::WholeSlice();
  for (r.seq = 0; r.seq < 5; ++r.seq)
    ASSERT_EQ(Push(r, GST_LIDAR_ECN_ECT1, "10.0.0.1"), GST_FLOW_OK);
  EXPECT_EQ(Stats(element)["peer-moves"], 1U);
}

TEST_F(ScreamRx, DropsARecordingThatIsOlderThanAskedFor) {
  for (const bool asked : {false, true}) {
    if (asked) g_object_set(element, "max-age", guint64{2 * GST_SECOND}, nullptr);
    Start();
    gst_harness_set_src_caps_str(rtp.get(),
                                 "application/x-rtp, media=(string)application, payload=(int)96, "
                                 "clock-rate=(int)90000, encoding-name=(string)X-LIDAR-DRACO");
    const auto now = static_cast<std::uint64_t>(g_get_real_time()) * 1000;
    constexpr std::uint64_t kSecond = GST_SECOND;
    Rtp r;
    for (const std::uint64_t captured :
         {now - 3600 * kSecond, now - 3 * kSecond, now + 3 * kSecond, now - kSecond / 10}) {
      ++r.seq;
      r.payload = WholeSlice(lidar::rtp::ToNtp(captured));
      ASSERT_EQ(Push(r), GST_FLOW_OK);
    }
    ++r.seq;
    r.payload = WholeSlice();  // says nothing: as the one before
    ASSERT_EQ(Push(r), GST_FLOW_OK);
    EXPECT_EQ(Passed(), asked ? 2U : 5U);
    EXPECT_EQ(Stats(element)["packets-old"], asked ? 3U : 0U);
    rtcp.reset();
    rtp.reset();
  }
}

TEST_F(ScreamRx, GoesOnWithThePeerWhereSomebodyElseSendsARecordingOfItsSsrc) {
  g_object_set(element, "max-age", guint64{2 * GST_SECOND}, nullptr);
  Start();
  gst_harness_set_src_caps_str(rtp.get(),
                               "application/x-rtp, media=(string)application, payload=(int)96, "
                               "clock-rate=(int)90000, encoding-name=(string)X-LIDAR-DRACO");
  const auto now = static_cast<std::uint64_t>(g_get_real_time()) * 1000;
  Rtp r;
  r.payload = WholeSlice(lidar::rtp::ToNtp(now));
  ASSERT_EQ(Push(r, GST_LIDAR_ECN_ECT1, "10.0.0.1"), GST_FLOW_OK);
  ++r.seq;
  Rtp recorded = r;
  recorded.payload = WholeSlice(lidar::rtp::ToNtp(now - 3600 * GST_SECOND));
  ASSERT_EQ(Push(recorded, GST_LIDAR_ECN_ECT1, "10.0.0.9"), GST_FLOW_OK);
  r.payload = WholeSlice();  // says nothing: as the one before
  ASSERT_EQ(Push(r, GST_LIDAR_ECN_ECT1, "10.0.0.1"), GST_FLOW_OK);
  EXPECT_EQ(Passed(), 2U);
  EXPECT_EQ(Stats(element)["packets-old"], 1U);
}

TEST_F(ScreamRx, EndsWhenEveryStreamSaidGoodbye) {
  Start();
  Rtp other;
  other.ssrc = 0x5678;
  ASSERT_EQ(Push({}), GST_FLOW_OK);
  ASSERT_EQ(Push(other), GST_FLOW_OK);
  EXPECT_EQ(PushBye({0x1234}), GST_FLOW_OK);
  EXPECT_EQ(PushBye({0x9999}), GST_FLOW_OK);  // of nobody we know
  EXPECT_EQ(Push(other), GST_FLOW_OK);
  EXPECT_EQ(PushBye({0x5678}), GST_FLOW_EOS);
  EXPECT_EQ(Push(other), GST_FLOW_EOS);
  bool eos = false;
  while (EventPtr event{gst_harness_try_pull_event(rtp.get())})
    eos = eos || GST_EVENT_TYPE(event.get()) == GST_EVENT_EOS;
  EXPECT_TRUE(eos);
  EXPECT_EQ(Passed(), 3U);
}

TEST_F(ScreamRx, EndsWithASenderThatRestartedThoughItsFirstSsrcNeverSaidGoodbye) {
  Start();
  Rtp next;
  next.ssrc = 0x5678;
  ASSERT_EQ(Push({}), GST_FLOW_OK);
  time.Settle();
  time.Advance(3 * GST_SECOND);
  ASSERT_EQ(Push(next), GST_FLOW_OK);
  EXPECT_EQ(PushBye({0x5678}), GST_FLOW_OK);  // the first may go on
  next.seq = 1;
  ASSERT_EQ(Push(next), GST_FLOW_OK);
  time.Settle();
  time.Advance(3 * GST_SECOND);
  EXPECT_EQ(PushBye({0x5678}), GST_FLOW_EOS);
}

TEST_F(ScreamRx, IgnoresAStrangersGoodbye) {
  Start();
  ASSERT_EQ(Push({}, GST_LIDAR_ECN_ECT1, "10.0.0.1"), GST_FLOW_OK);
  EXPECT_EQ(PushBye({0x1234}, "10.0.0.2"), GST_FLOW_OK);
  Rtp r;
  r.seq = 1;
  EXPECT_EQ(Push(r, GST_LIDAR_ECN_ECT1, "10.0.0.1"), GST_FLOW_OK);
  EXPECT_EQ(Passed(), 2U);
}

TEST_F(ScreamRx, ShowsWhatItsSenderReports) {
  Start();
  EXPECT_EQ(Stats(element)["sender-reports"], 0U);
  ASSERT_EQ(Push({}, GST_LIDAR_ECN_ECT1, "10.0.0.1"), GST_FLOW_OK);
  scream::SenderReport report;
  report.ssrc = 0x1234;
  report.time_ms = 0xffffff00;
  report.target_bitrate = DataRate::BitsPerSecond(7e6);
  report.queue_delay = std::chrono::milliseconds(3);
  report.packets_lost = 11;
  ASSERT_EQ(PushReport(report), GST_FLOW_OK);
  time.Settle();
  time.Advance(250 * GST_MSECOND);
  const Stats stats(element);
  EXPECT_EQ(stats["sender-reports"], 1U);
  EXPECT_EQ(stats["sender-target-bitrate"], 7'000'000U);
  EXPECT_EQ(stats["sender-queue-delay"], 3 * GST_MSECOND);
  EXPECT_EQ(stats["sender-packets-lost"], 11U);
  EXPECT_EQ(stats["sender-report-age"], 250 * GST_MSECOND);
  report.time_ms += 1000;  // over the wrap
  report.packets_lost = 12;
  ASSERT_EQ(PushReport(report), GST_FLOW_OK);
  EXPECT_EQ(Stats(element)["sender-packets-lost"], 12U);
  EXPECT_EQ(Passed(), 1U);
}

TEST_F(ScreamRx, BelievesNoReportThatIsOldOrOfSomebodyElse) {
  Start();
  ASSERT_EQ(Push({}, GST_LIDAR_ECN_ECT1, "10.0.0.1"), GST_FLOW_OK);
  scream::SenderReport report;
  report.ssrc = 0x1234;
  report.time_ms = 5000;
  ASSERT_EQ(PushReport(report), GST_FLOW_OK);
  ASSERT_EQ(PushReport(report), GST_FLOW_OK);  // twice
  report.time_ms = 4000;
  ASSERT_EQ(PushReport(report), GST_FLOW_OK);
  report.time_ms = 6000;
  ASSERT_EQ(PushReport(report, "10.0.0.2"), GST_FLOW_OK);
  report.ssrc = 0x9999;
  ASSERT_EQ(PushReport(report), GST_FLOW_OK);
  EXPECT_EQ(Stats(element)["sender-reports"], 1U);
  EXPECT_EQ(Stats(element)["packets-foreign"], 1U);
  EXPECT_EQ(Passed(), 1U);
}

TEST_F(ScreamRx, DropsAReportOfAVersionToCome) {
  Start();
  ASSERT_EQ(Push({}), GST_FLOW_OK);
  scream::SenderReport report;
  report.ssrc = 0x1234;
  auto bytes = scream::BuildSenderReport(report);
  bytes[8] = 0x82;
  ASSERT_EQ(gst_harness_push(rtp.get(), FromBytes(bytes)), GST_FLOW_OK);
  EXPECT_EQ(Stats(element)["sender-reports"], 0U);
  EXPECT_EQ(Passed(), 1U);
}

TEST_F(ScreamRx, WaitsForTheNextSenderWhereAskedTo) {
  g_object_set(element, "eos-on-bye", FALSE, nullptr);
  Start();
  ASSERT_EQ(Push({}), GST_FLOW_OK);
  EXPECT_EQ(PushBye({0x1234}), GST_FLOW_OK);
  Rtp again;
  again.ssrc = 0x4321;
  EXPECT_EQ(Push(again), GST_FLOW_OK);
  EXPECT_EQ(Passed(), 2U);
}

TEST_F(ScreamRx, CountsAndDropsGarbage) {
  Start();
  ASSERT_EQ(gst_harness_push(rtp.get(), FromBytes({})), GST_FLOW_OK);
  ASSERT_EQ(gst_harness_push(rtp.get(), FromBytes({0x80})), GST_FLOW_OK);
  ASSERT_EQ(gst_harness_push(rtp.get(), FromBytes(std::vector<std::uint8_t>(100, 7))), GST_FLOW_OK);
  EXPECT_EQ(Passed(), 0U);
  EXPECT_EQ(Stats(element)["malformed"], 3U);
}

TEST_F(ScreamRx, PassesListsWithoutTheirForeignPackets) {
  Start();
  GstBufferList* list = gst_buffer_list_new();
  for (guint16 seq = 0; seq < 6; ++seq) {
    Rtp r;
    r.seq = seq;
    GstBuffer* buffer = NewRtp(r);
    SetSource(buffer, seq % 2 == 0 ? "10.0.0.1" : "10.0.0.2", 5000);
    gst_buffer_list_add(list, buffer);
  }
  ASSERT_EQ(gst_pad_push_list(rtp->srcpad, list), GST_FLOW_OK);
  EXPECT_EQ(Passed(), 3U);
}

TEST_F(ScreamRx, ReadsItselfInEricssonsWayWhereAsked) {
  gst_util_set_object_arg(G_OBJECT(element), "num-reports", "ericsson");
  Start();
  ASSERT_EQ(Push({}), GST_FLOW_OK);
  gst_buffer_unref(gst_harness_pull(rtcp.get()));
  for (guint16 seq = 1; seq < 3; ++seq) {
    Rtp r;
    r.seq = seq;
    r.marker = seq == 2;
    ASSERT_EQ(Push(r), GST_FLOW_OK);
  }
  const BufferPtr buffer(gst_harness_pull(rtcp.get()));
  const auto bytes = ToBytes(buffer.get());
  ASSERT_GE(bytes.size(), 16U);
  EXPECT_EQ(bytes[14] << 8 | bytes[15], 2);  // three blocks, minus one
}

TEST_F(ScreamRx, GivesEachStreamAPadOfItsOwnWithPtMap) {
  GstStructure* map = gst_structure_from_string(
      "application/x-rtp-pt-map,"
      "96=(string)\"application/x-rtp,media=application,clock-rate=90000,encoding-name=TEST\","
      "97=(string)\"application/x-rtp,media=video,clock-rate=90000,encoding-name=H264\"",
      nullptr);
  ASSERT_TRUE(map);
  g_object_set(element, "pt-map", map, nullptr);
  gst_structure_free(map);
  Harness video;
  struct Added {
    Harness* harness;
    int pads = 0;
  } added{&video};
  g_signal_connect(element, "pad-added", G_CALLBACK(+[](GstElement* e, GstPad* pad, Added* a) {
                     gchar* name = gst_pad_get_name(pad);
                     if (g_str_has_prefix(name, "src_")) {
                       a->harness->reset(gst_harness_new_with_element(e, nullptr, name));
                       ++a->pads;
                     }
                     g_free(name);
                   }),
                   &added);
  Start();
  gst_harness_set_sink_caps_str(rtp.get(), "application/x-rtp,media=application");
  for (guint16 seq = 0; seq < 4; ++seq) {
    Rtp camera;
    camera.ssrc = 0x5678;
    camera.payload_type = 97;
    camera.seq = seq;
    ASSERT_EQ(Push(camera), GST_FLOW_OK);
    Rtp lidar;
    lidar.seq = seq;
    ASSERT_EQ(Push(lidar), GST_FLOW_OK);
    Rtp repair;  // not in the map: stays with the first
    repair.ssrc = 0x9abc;
    repair.payload_type = 110;
    repair.seq = seq;
    ASSERT_EQ(Push(repair), GST_FLOW_OK);
  }
  EXPECT_EQ(added.pads, 1);
  ASSERT_TRUE(video);
  EXPECT_EQ(gst_harness_buffers_received(video.get()), 4U);
  EXPECT_EQ(Passed(), 8U);
  const CapsPtr caps(gst_pad_get_current_caps(video->sinkpad));
  ASSERT_TRUE(caps);
  const GstStructure* s = gst_caps_get_structure(caps.get(), 0);
  EXPECT_STREQ(gst_structure_get_string(s, "encoding-name"), "H264");
  gint payload = 0;
  EXPECT_TRUE(gst_structure_get_int(s, "payload", &payload));
  EXPECT_EQ(payload, 97);
  video.reset();
}

TEST_F(ScreamRx, WarnsOfWhatIsWrongWithPtMapAndOfAStreamThatNobodyTakes) {
  GstStructure* map = gst_structure_from_string(
      "application/x-rtp-pt-map,"
      "72=(string)\"application/x-rtp,media=video,clock-rate=90000,encoding-name=H264\","
      "97=(string)\"application/x-rtp,media=video,clock-rate=90000,encoding-name=H264\","
      "98=(string)\"application/x-rtp,clock-rate=[1,2]\",200=(int)7,lidar=(int)96",
      nullptr);
  ASSERT_TRUE(map);
  g_object_set(element, "pt-map", map, nullptr);
  gst_structure_free(map);
  GstBus* bus = gst_bus_new();
  gst_element_set_bus(element, bus);
  Start();
  std::string texts;
  const auto warnings = [&] {
    int n = 0;
    for (; const gst::MessagePtr message{gst_bus_pop_filtered(bus, GST_MESSAGE_WARNING)}; ++n) {
      GError* error = nullptr;
      gst_message_parse_warning(message.get(), &error, nullptr);
      texts += gst::ErrorPtr(error)->message + std::string("\n");
    }
    return n;
  };
  EXPECT_EQ(warnings(), 4);
  EXPECT_NE(texts.find("72 is RTCP"), std::string::npos) << texts;
  gst_harness_set_sink_caps_str(rtp.get(), "application/x-rtp,media=application");
  for (guint16 seq = 0; seq < 4; ++seq) {
    Rtp camera;
    camera.ssrc = 0x5678;
    camera.payload_type = 97;
    camera.seq = seq;
    EXPECT_EQ(Push(camera), GST_FLOW_OK);
  }
  EXPECT_EQ(warnings(), 1);
  EXPECT_NE(texts.find("payload type 97"), std::string::npos) << texts;
  gst_element_set_bus(element, nullptr);
  gst_object_unref(bus);
}

TEST_F(ScreamRx, StartsAfreshAfterEveryStateCycle) {
  Start();
  ASSERT_EQ(Push({}, GST_LIDAR_ECN_ECT1, "10.0.0.1"), GST_FLOW_OK);
  gst_element_set_state(element, GST_STATE_NULL);
  gst_element_set_state(element, GST_STATE_PLAYING);
  EXPECT_EQ(Stats(element)["packets-received"], 0U);
  EXPECT_EQ(Stats(element)["ssrcs"], 0U);
}

}  // namespace
}  // namespace lidar::test
