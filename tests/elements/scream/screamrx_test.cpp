// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of screamrx under a test clock: what it reports, to which addresses it reports, and which
// packets it accepts.
#include <atomic>
#include <set>

#include "gst/net/udp_socket.h"
#include "gst/scream/key_request.h"
#include "src/rtp/ntp_time.h"
#include "tests/elements/scream/screamrx_fixture.h"
#include "tests/support/patience.h"

namespace lidar::test {
namespace {

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

TEST_F(ScreamRx, CarriesTheWishForAKeyUnitOverEachLink) {
  g_object_set(element, "ssrc", 77, nullptr);
  Start();
  for (guint16 seq = 1; seq < 8; ++seq) {
    Rtp r;
    r.seq = seq;
    for (const char* host : {"10.0.0.1", "10.0.0.2"}) Push(r, GST_LIDAR_ECN_ECT1, host);
  }
  GstStructure* wish = gst_structure_new_empty("GstForceKeyUnit");
  ASSERT_TRUE(gst_harness_push_upstream_event(
      rtp.get(), gst_event_new_custom(GST_EVENT_CUSTOM_UPSTREAM, wish)));
  std::set<std::string> asked;
  for (int packets = 0; packets < 20 && asked.size() < 2; ++packets) {
    const BufferPtr packet(gst_harness_pull(rtcp.get()));
    ASSERT_TRUE(packet);
    if (ToBytes(packet.get()) != gst::BuildKeyRequest(77, 0x1234)) continue;
    asked.insert(gst::AddressToString(gst::SourceOf(packet.get())));
  }
  EXPECT_EQ(asked, (std::set<std::string>{"10.0.0.1:5000", "10.0.0.2:5000"}));
}

TEST_F(ScreamRx, ReportsEachPacketOfAFrameAtItsMarker) {
  g_object_set(element, "ssrc", 77, nullptr);
  Start();
  const GstLidarEcn ecns[] = {GST_LIDAR_ECN_ECT1, GST_LIDAR_ECN_ECT1, GST_LIDAR_ECN_ECT1,
                              GST_LIDAR_ECN_CE};
  PushFirst(65534);
  for (guint16 i = 1; i < 4; ++i) {
    Rtp r;
    r.seq = static_cast<guint16>(65534 + i);  // the numbers wrap
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

TEST_F(ScreamRx, ASenderMayBeginAgainWithNumbersThatItUsedBefore) {
  Start();
  Rtp r;
  r.marker = true;
  for (r.seq = 0; r.seq < 1'000; ++r.seq) {
    ASSERT_EQ(Push(r), GST_FLOW_OK);
    Report();
  }
  for (const guint16 begin : std::initializer_list<guint16>{0, 500, 990}) {
    ++r.timestamp;
    r.seq = begin;
    for (; r.seq < 1'000; ++r.seq) {
      ASSERT_EQ(Push(r), GST_FLOW_OK);
      const CongestionFeedback report = Report();
      ASSERT_EQ(report.blocks.size(), 1U) << r.seq;
      const rtcp::SsrcReport& block = report.blocks[0];
      EXPECT_EQ(block.begin_seq + block.metrics.size(), r.seq + 1U);
      ASSERT_GE(block.begin_seq, begin) << "nothing of before";
    }
  }
  EXPECT_EQ(Stats(element)["packets-lost"], 0U);
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
  const auto latest = static_cast<GstClockTime>(g_get_real_time()) * GST_USECOND;
  EXPECT_LT(Milliseconds(*offset), 502 + static_cast<double>((latest - unix_now) / GST_MSECOND));
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
    EXPECT_LT(Milliseconds(*offset), 100) << set_s;  // the test's clock does not advance
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

TEST_F(ScreamRx, PassesOnceWhatCameByTwoLinksAndAnswersBoth) {
  Start();
  for (guint run = 1; run <= 2; ++run) {
    Restart();
    for (guint16 seq = 0; seq < 20; ++seq) {
      Rtp r;
      r.seq = seq;
      r.marker = true;
      ASSERT_EQ(Push(r, GST_LIDAR_ECN_ECT1, "10.0.0.1", 4711), GST_FLOW_OK);
      const GstLidarEcn ecn = seq == 19 ? GST_LIDAR_ECN_CE : GST_LIDAR_ECN_ECT1;
      ASSERT_EQ(Push(r, ecn, "10.1.0.1", 4712), GST_FLOW_OK);
      time.Advance(20 * GST_MSECOND);
    }
    EXPECT_EQ(Passed(), run * 20);
  }
  std::set<guint16> answered;
  while (gst_harness_buffers_in_queue(rtcp.get()) > 0) {
    BufferPtr raw;
    Report(&raw);
    const GstNetAddressMeta* meta = gst_buffer_get_net_address_meta(raw.get());
    answered.insert(g_inet_socket_address_get_port(G_INET_SOCKET_ADDRESS(meta->addr)));
  }
  EXPECT_EQ(answered, (std::set<guint16>{4711, 4712}));
  const Stats links[] = {Stats(element).Of("links", 0), Stats(element).Of("links", 1)};
  EXPECT_EQ(links[0].Text("address"), "10.0.0.1:4711");
  EXPECT_EQ(links[1].Text("address"), "10.1.0.1:4712");
  EXPECT_EQ(links[0]["packets-received"], 20U);
  EXPECT_EQ(links[1]["packets-received"], 17U);
  EXPECT_EQ(links[1]["bytes-received"], 17U * 1228);
  EXPECT_EQ(links[1]["packets-ce"], 1U);
  // The first three copies count as foreign packets, because the second address was not yet known
  // as a link of the peer.
  EXPECT_EQ(Stats(element)["packets-foreign"], 3U);
  EXPECT_EQ(Stats(element)["packets-copies"], 17U);
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
  // The first four packets from the new address are dropped: they are its probation.
  EXPECT_EQ(Passed(), 7U);
  EXPECT_EQ(Stats(element)["peer-moves"], 1U);
  r.seq = 11;
  r.marker = true;
  ASSERT_EQ(Push(r, GST_LIDAR_ECN_ECT1, "10.0.0.2"), GST_FLOW_OK);
  rtcp::SsrcReport last;
  do {
    const CongestionFeedback report = Report();
    ASSERT_EQ(report.blocks.size(), 1U);
    last = report.blocks[0];
  } while (last.begin_seq + last.metrics.size() <= 11);
  EXPECT_EQ(last.begin_seq, 5);  // the report omits the packets of the old address
}

TEST_F(ScreamRx, ShowsNothingOfTheOldPeerAfterAMove) {
  Start();
  Rtp r;
  for (const guint16 seq : std::initializer_list<guint16>{
           0, 1, 1, 9, 8}) {  // a duplicate, a gap, and an overtaken packet
    r.seq = seq;
    ASSERT_EQ(Push(r, GST_LIDAR_ECN_CE, "10.0.0.1"), GST_FLOW_OK);
  }
  rtcp::SenderReport report;
  report.ssrc = r.ssrc;
  report.packets_sent = 5;
  ASSERT_EQ(PushReport(report, "10.0.0.1"), GST_FLOW_OK);
  constexpr const char* kOfPeer[] = {
      "packets-received",  "bytes-received",    "packets-ce", "packets-lost",
      "packets-reordered", "packets-duplicate", "ssrcs",      "sender-packets-sent",
      "sender-reports"};
  for (const char* field : kOfPeer) EXPECT_GT(Stats(element)[field], 0U) << field;
  time.Settle();
  time.Advance(600 * GST_MSECOND);
  r.ssrc = 0x5678;
  for (r.seq = 0; Stats(element)["peer-moves"] == 0 && r.seq < 9; ++r.seq)
    ASSERT_EQ(Push(r, GST_LIDAR_ECN_ECT1, "10.0.0.2"), GST_FLOW_OK);
  const Stats stats(element);
  EXPECT_EQ(stats["peer-moves"], 1U);
  for (const char* field : kOfPeer) {
    const std::string name = field;
    const guint64 one =
        name == "bytes-received" ? 1'228 : name == "packets-received" || name == "ssrcs";
    EXPECT_EQ(stats[field], one) << field;
  }
}

/// The sender restarts with the same SSRC, and from then on uses two links.
TEST_F(ScreamRx, PassesWhatTheNewPeerSendsUnderNumbersOfTheOld) {
  Start();
  Rtp r;
  for (r.seq = 0; r.seq < 60; ++r.seq)
    ASSERT_EQ(Push(r, GST_LIDAR_ECN_ECT1, "10.0.0.1"), GST_FLOW_OK);
  time.Settle();
  time.Advance(2 * GST_SECOND);
  for (r.seq = 10; Stats(element)["peer-moves"] == 0 && r.seq < 20; ++r.seq)
    ASSERT_EQ(Push(r, GST_LIDAR_ECN_ECT1, "10.0.0.2"), GST_FLOW_OK);
  const guint before = Passed(), first = r.seq;
  for (; r.seq < 40; ++r.seq)
    for (const char* host : {"10.0.0.2", "10.0.0.3"})
      ASSERT_EQ(Push(r, GST_LIDAR_ECN_ECT1, host), GST_FLOW_OK);
  EXPECT_EQ(Passed() - before, 40 - first) << "each once";
  EXPECT_GT(Stats(element)["packets-copies"], 10U);
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
    constexpr std::uint64_t kHour = 3600 * GST_SECOND;
    if (asked) g_object_set(element, "max-age", guint64{2 * kHour}, nullptr);
    Start();
    gst_harness_set_src_caps_str(rtp.get(),
                                 "application/x-rtp, media=(string)application, payload=(int)96, "
                                 "clock-rate=(int)90000, encoding-name=(string)X-LIDAR-DRACO");
    const auto now = static_cast<std::uint64_t>(g_get_real_time()) * 1000;
    Rtp r;
    for (const std::uint64_t captured :
         {now - 3600 * kHour, now - 3 * kHour, now + 3 * kHour, now - kHour / 10}) {
      ++r.seq;
      r.payload = WholeSlice(lidar::rtp::ToNtp(captured));
      ASSERT_EQ(Push(r), GST_FLOW_OK);
    }
    ++r.seq;
    // A slice without a capture time gets the age of the slice before it.
    r.payload = WholeSlice();
    ASSERT_EQ(Push(r), GST_FLOW_OK);
    EXPECT_EQ(Passed(), asked ? 2U : 5U);
    EXPECT_EQ(Stats(element)["packets-old"], asked ? 3U : 0U);
    rtcp.reset();
    rtp.reset();
  }
}

/// A slice without a capture time gets the age of the slice before it. A new run must not use the
/// age of a slice of the run before.
TEST_F(ScreamRx, JudgesTheAgeOfSlicesAnewInEachRun) {
  g_object_set(element, "max-age", guint64{2 * GST_SECOND}, nullptr);
  Start();
  Rtp without, recorded;
  without.payload = WholeSlice();
  recorded.seq = 1;
  recorded.payload = WholeSlice(lidar::rtp::ToNtp(GST_SECOND));
  for (int run = 0; run < 2; ++run) {
    gst_harness_set_src_caps_str(rtp.get(),
                                 "application/x-rtp, media=(string)application, payload=(int)96, "
                                 "clock-rate=(int)90000, encoding-name=(string)X-LIDAR-DRACO");
    EXPECT_EQ(Push(without), GST_FLOW_OK);
    EXPECT_EQ(Push(recorded), GST_FLOW_OK);
    EXPECT_EQ(Stats(element)["packets-old"], 1U) << run;
    EXPECT_EQ(Stats(element)["packets-received"], 1U) << run;
    Restart();
  }
}

/// Payload type 96 is LiDAR at first, then other media, then LiDAR again.
TEST_F(ScreamRx, JudgesTheAgeOfNothingThatIsLidarNoMore) {
  g_object_set(element, "max-age", guint64{2 * GST_SECOND}, nullptr);
  Start();
  Rtp recorded;
  recorded.payload = WholeSlice(lidar::rtp::ToNtp(GST_SECOND));
  const auto old = [&] {
    ++recorded.seq;
    EXPECT_EQ(Push(recorded), GST_FLOW_OK);
    return Stats(element)["packets-old"];
  };
  for (const char* encoding : {"X-LIDAR-DRACO", "TEST", "X-LIDAR-MIXING"}) {
    const std::string caps =
        "application/x-rtp, media=(string)application, payload=(int)96, clock-rate=(int)90000, "
        "encoding-name=(string)" +
        std::string(encoding);
    gst_harness_set_src_caps_str(rtp.get(), caps.c_str());
    const guint64 before = Stats(element)["packets-old"];
    EXPECT_EQ(old() - before, caps.find("X-LIDAR") == std::string::npos ? 0U : 1U) << caps;
  }
  for (const char* encoding : {"X-LIDAR-DRACO", "TEST"}) {
    gst_element_set_state(element, GST_STATE_NULL);
    SetPtMap("96=(string)\"application/x-rtp,media=application,clock-rate=90000,encoding-name=" +
             std::string(encoding) + "\"");
    gst_harness_play(rtp.get());
    gst_harness_play(rtcp.get());
    gst_harness_set_src_caps_str(rtp.get(), kRtpCaps);
    EXPECT_EQ(old(), encoding == std::string("TEST") ? 0U : 1U) << encoding;
  }
}

TEST_F(ScreamRx, GoesOnWithThePeerWhereSomebodyElseSendsARecordingOfItsSsrc) {
  g_object_set(element, "max-age", guint64{1800 * GST_SECOND}, nullptr);
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
  // A slice without a capture time gets the age of the slice before it.
  r.payload = WholeSlice();
  ASSERT_EQ(Push(r, GST_LIDAR_ECN_ECT1, "10.0.0.1"), GST_FLOW_OK);
  EXPECT_EQ(Passed(), 2U);
  EXPECT_EQ(Stats(element)["packets-old"], 1U);
}

TEST_F(ScreamRx, CountsBytesAsTheyAreOnTheWire) {
  g_object_set(element, "packet-overhead", 100U, nullptr);
  Start();
  ASSERT_EQ(Push({}), GST_FLOW_OK);
  EXPECT_EQ(Stats(element)["bytes-received"], 1200U + 100);
}

TEST_F(ScreamRx, CountsItsReportsAndWhatNoReportCanTell) {
  Start();
  PushFirst(0);
  EXPECT_EQ(Stats(element)["reports-sent"], 1U);
  EXPECT_EQ(Stats(element)["report-bytes"], 28U + 12 + 8 + 4) << "with all headers";
  Rtp r;
  for (const guint16 far : std::initializer_list<guint16>{20'000, 40'000}) {
    r.seq = far;
    ASSERT_EQ(Push(r), GST_FLOW_OK);
  }
  r.seq = 0;
  ASSERT_EQ(Push(r), GST_FLOW_OK);
  const Stats stats(element);
  EXPECT_FALSE(gst_structure_has_field(StatsOf(element).get(), "links")) << "there is one";
  EXPECT_EQ(stats["packets-stale"], 2U);
  EXPECT_EQ(stats["packets-duplicate"], 1U);
  EXPECT_EQ(stats["packets-received"], 4U);
  for (const char* field :
       {"packets-ce", "packets-lost", "packets-reordered", "packets-copies", "packets-foreign",
        "malformed", "packets-old", "peer-moves", "goodbyes"})
    EXPECT_EQ(stats[field], 0U) << field;
}

TEST_F(ScreamRx, RemembersSoManySsrcsAtMost) {
  Start();
  Rtp r;
  for (r.ssrc = 1; r.ssrc <= 100; ++r.ssrc) ASSERT_EQ(Push(r), GST_FLOW_OK);
  EXPECT_EQ(Stats(element)["ssrcs"], 64U);
}

TEST_F(ScreamRx, ReportsAsOftenAsItIsToldToWhileItPlays) {
  Start();
  PushFirst(0);
  g_object_set(element, "packets-per-feedback", 2U, nullptr);
  time.Settle();
  Rtp r;
  for (r.seq = 1; r.seq <= 2; ++r.seq) ASSERT_EQ(Push(r), GST_FLOW_OK);
  ASSERT_TRUE(Eventually([&] { return gst_harness_buffers_received(rtcp.get()) == 2; }));
}

TEST_F(ScreamRx, RefusesTheWishForAKeyUnitWhereNobodySends) {
  Start();
  GstStructure* wish = gst_structure_new_empty("GstForceKeyUnit");
  EXPECT_FALSE(gst_harness_push_upstream_event(
      rtp.get(), gst_event_new_custom(GST_EVENT_CUSTOM_UPSTREAM, wish)));
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
  EXPECT_EQ(bytes[14] << 8 | bytes[15], 2);  // num_reports is the number of metric blocks minus one
}

TEST_F(ScreamRx, StartsAfreshAfterEveryStateCycle) {
  Start();
  ASSERT_EQ(Push({}, GST_LIDAR_ECN_ECT1, "10.0.0.1"), GST_FLOW_OK);
  ASSERT_EQ(Push({}, GST_LIDAR_ECN_ECT1, "10.0.0.2"), GST_FLOW_OK);
  rtcp::SenderReport report;
  report.ssrc = 0x1234;
  ASSERT_EQ(PushReport(report), GST_FLOW_OK);
  ASSERT_EQ(PushBye({0x1234}, "10.0.0.1"), GST_FLOW_EOS);
  Report();
  Restart();
  for (const char* counter :
       {"packets-received", "ssrcs", "packets-foreign", "sender-reports", "goodbyes"})
    EXPECT_EQ(Stats(element)[counter], 0U) << counter;
  while (EventPtr event{gst_harness_try_pull_event(rtcp.get())}) continue;
  // In this run, the first packet comes from the address that was foreign before.
  EXPECT_EQ(Push({}, GST_LIDAR_ECN_ECT1, "10.0.0.2"), GST_FLOW_OK);
  EXPECT_EQ(Stats(element)["packets-foreign"], 0U);
  Report();
  for (const GstEventType type : {GST_EVENT_STREAM_START, GST_EVENT_CAPS, GST_EVENT_SEGMENT}) {
    const EventPtr event(gst_harness_pull_event(rtcp.get()));
    ASSERT_TRUE(event) << gst_event_type_get_name(type);
    EXPECT_EQ(GST_EVENT_TYPE(event.get()), type);
  }
}

TEST_F(ScreamRx, AsksForNoKeyUnitOfTheRunBefore) {
  Start();
  std::atomic<bool> blocked{false};
  const gst::PadPtr pad(gst_element_get_static_pad(element, "rtcp_src"));
  const gulong probe = gst_pad_add_probe(
      pad.get(), static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BLOCK | GST_PAD_PROBE_TYPE_BUFFER),
      [](GstPad*, GstPadProbeInfo*, gpointer flag) -> GstPadProbeReturn {
        *static_cast<std::atomic<bool>*>(flag) = true;
        return GST_PAD_PROBE_OK;
      },
      &blocked, nullptr);
  ASSERT_EQ(Push({}), GST_FLOW_OK);
  ASSERT_TRUE(Eventually([&] { return blocked.load(); }));
  // There are so many SSRCs that the element stops before it has sent all requests.
  Rtp r;
  for (r.ssrc = 1; r.ssrc <= 60; ++r.ssrc) ASSERT_EQ(Push(r), GST_FLOW_OK);
  GstStructure* wish = gst_structure_new_empty("GstForceKeyUnit");
  ASSERT_TRUE(gst_harness_push_upstream_event(
      rtp.get(), gst_event_new_custom(GST_EVENT_CUSTOM_UPSTREAM, wish)));
  gst_element_set_state(element, GST_STATE_NULL);
  gst_pad_remove_probe(pad.get(), probe);
  while (BufferPtr{gst_harness_try_pull(rtcp.get())}) continue;
  gst_harness_play(rtp.get());
  gst_harness_play(rtcp.get());
  r.ssrc = 0x5678;
  ASSERT_EQ(Push(r), GST_FLOW_OK);
  ASSERT_EQ(Report().blocks.size(), 1U) << "nothing comes before the report";
}

TEST_F(ScreamRx, ReportsToTheNextSinkAfterOneThatStopped) {
  Start();
  Rtp r;
  r.marker = true;
  for (const GstFlowReturn flow : {GST_FLOW_FLUSHING, GST_FLOW_EOS}) {
    std::atomic<int> refusal = flow;
    const auto refuse = [](GstPad*, GstPadProbeInfo* info, gpointer data) {
      gst_buffer_unref(GST_PAD_PROBE_INFO_BUFFER(info));
      auto& value = *static_cast<std::atomic<int>*>(data);
      GST_PAD_PROBE_INFO_FLOW_RETURN(info) = static_cast<GstFlowReturn>(value.exchange(0));
      return GST_PAD_PROBE_HANDLED;
    };
    const gulong probe =
        gst_pad_add_probe(rtcp->sinkpad, GST_PAD_PROBE_TYPE_BUFFER, refuse, &refusal, nullptr);
    ++r.seq;
    ASSERT_EQ(Push(r), GST_FLOW_OK);
    ASSERT_TRUE(Eventually([&] { return refusal == 0; }));
    gst_pad_remove_probe(rtcp->sinkpad, probe);
    ++r.seq;
    ASSERT_EQ(Push(r), GST_FLOW_OK);
    ASSERT_EQ(Report().blocks.size(), 1U) << gst_flow_get_name(flow);
  }
}

}  // namespace
}  // namespace lidar::test
