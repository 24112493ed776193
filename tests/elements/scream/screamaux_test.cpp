// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of screamaux before a session whose events the test sends, and before GStreamer's own
// rtpbin.
#include <gtest/gtest.h>

#include <array>

#include "src/rtcp/twcc_mapper.h"
#include "tests/elements/scream/pipeline.h"
#include "tests/elements/scream/rtp_support.h"
#include "tests/support/free_ports.h"
#include "tests/support/patience.h"

namespace lidar::test {
namespace {

constexpr guint8 kExtension = 3;

struct Told {
  guint number = 0;
  guint size = 100;
  bool lost = false;
  guint64 arrival = GST_SECOND;
};

/// Returns a report about `packets`, as the event that rtpsession sends upstream.
GstEvent* Report(const std::vector<Told>& packets) {
  GValue list = G_VALUE_INIT;
  g_value_init(&list, g_type_from_name("GValueArray"));
  GValueArray array{};
  std::vector<GValue> values(packets.size(), GValue G_VALUE_INIT);
  for (std::size_t i = 0; i < packets.size(); ++i) {
    const Told& p = packets[i];
    g_value_init(&values[i], GST_TYPE_STRUCTURE);
    g_value_take_boxed(
        &values[i],
        gst_structure_new("RTPTWCCPacket", "seqnum", G_TYPE_UINT, p.number, "size", G_TYPE_UINT,
                          p.size, "lost", G_TYPE_BOOLEAN, static_cast<gboolean>(p.lost),
                          "remote-ts", G_TYPE_UINT64,
                          p.lost ? GST_CLOCK_TIME_NONE : p.arrival + i * GST_MSECOND, nullptr));
  }
  array.n_values = static_cast<guint>(values.size());
  array.values = values.data();
  g_value_set_boxed(&list, &array);
  GstStructure* s = gst_structure_new_empty("RTPTWCCPackets");
  gst_structure_take_value(s, "packets", &list);
  for (GValue& value : values) g_value_unset(&value);
  return gst_event_new_custom(GST_EVENT_CUSTOM_UPSTREAM, s);
}

class ScreamAux : public ::testing::Test {
 protected:
  FakeTime time;
  GstElement* element = gst_element_factory_make("screamaux", nullptr);
  Harness harness{gst_harness_new_with_element(element, "sink", "src")};
  guint16 seq = 65534;
  guint8 extension = kExtension;  // id of the RTP header extension with the packet's number

  void SetUp() override {
    // GObject registers the type GValueArray only when it is used for the first time.
    g_type_class_ref(G_TYPE_OBJECT);
    ASSERT_NE(g_type_from_name("GValueArray"), G_TYPE_INVALID);
    SetCaps();
  }
  void SetCaps() {
    gst_harness_set_src_caps_str(
        harness.get(), (std::string(kRtpCaps) + ",extmap-3=(string)" + rtcp::kTwccUri).c_str());
  }
  /// Stops the element and plays it again.
  void Restart() {
    gst_element_set_state(element, GST_STATE_READY);
    gst_element_set_state(element, GST_STATE_PLAYING);
    gst_harness_play(harness.get());
    gst_harness_push_event(harness.get(), gst_event_new_stream_start("again"));
    SetCaps();
  }
  void TearDown() override {
    harness.reset();
    gst_object_unref(element);
  }
  void Push(bool numbered = true) {
    Rtp r;
    r.seq = seq++;
    r.timestamp = r.seq;
    r.marker = true;
    r.size = 100;
    GstBuffer* buffer = NewRtp(r);
    if (numbered) {
      GstRTPBuffer rtp = GST_RTP_BUFFER_INIT;
      gst_rtp_buffer_map(buffer, GST_MAP_READWRITE, &rtp);
      const guint16 number = 0;
      gst_rtp_buffer_add_extension_onebyte_header(&rtp, extension, &number, 2);
      gst_rtp_buffer_unmap(&rtp);
    }
    ASSERT_EQ(gst_harness_push(harness.get(), buffer), GST_FLOW_OK);
  }
  /// Advances the time. Returns the number of packets that the element has sent.
  int Leave(int rounds = 20) {
    int packets = 0;
    for (int i = 0; i < rounds; ++i) {
      time.Advance(10 * GST_MSECOND);
      while (BufferPtr buffer{gst_harness_try_pull(harness.get())}) ++packets;
    }
    return packets;
  }
  void Tell(const std::vector<Told>& packets) {
    gst_harness_push_upstream_event(harness.get(), Report(packets));
  }
  guint64 Stat(const char* field) { return Stats(element)[field]; }
};

TEST_F(ScreamAux, CountsWhatTheSessionReportsAsFeedback) {
  for (int i = 0; i < 4; ++i) Push();
  ASSERT_EQ(Leave(), 4);
  Tell({{0}, {1}, {2, 100, true}, {3}});
  EXPECT_EQ(Stat("twcc-reports"), 1U);
  EXPECT_EQ(Stat("twcc-packets"), 4U);
  EXPECT_EQ(Stat("feedback-accepted"), 1U);
  EXPECT_EQ(Stat("packets-acked"), 3U);
}

TEST_F(ScreamAux, NumbersOnlyPacketsThatHaveTheExtension) {
  Push();
  Push(false);
  Push();
  ASSERT_EQ(Leave(), 3);
  Tell({{0}, {1}});
  EXPECT_EQ(Stat("packets-acked"), 2U);
}

TEST_F(ScreamAux, ReportsAboutPacketsOfOthersAreNotBelieved) {
  for (int i = 0; i < 3; ++i) Push();
  ASSERT_EQ(Leave(), 3);
  Tell({{0, 1200}, {1, 700}, {2}});
  EXPECT_EQ(Stat("twcc-mismatched"), 1U);
  EXPECT_EQ(Stat("packets-acked"), 0U);
  Tell({{0}, {1}, {2}});
  EXPECT_EQ(Stat("packets-acked"), 3U);
}

TEST_F(ScreamAux, TheSizeOfAPacketIsKnownAsLongAsAReportMayTellOfIt) {
  for (int i = 0; i < 40; ++i) Push();
  ASSERT_EQ(Leave(200), 40);
  for (const guint size : {99U, 101U, 1200U}) Tell({{0, size}});
  EXPECT_EQ(Stat("twcc-mismatched"), 3U);
  EXPECT_EQ(Stat("packets-acked"), 0U);
  // A single packet with a wrong size makes the whole report invalid.
  Tell({{0}, {1}, {2, 99}});
  EXPECT_EQ(Stat("twcc-mismatched"), 4U);
  EXPECT_EQ(Stat("twcc-packets"), 0U);
  Tell({{0, 0}, {1}});  // a session may not report sizes
  EXPECT_EQ(Stat("packets-acked"), 2U);
  EXPECT_EQ(Stat("twcc-packets"), 2U);
  Tell({{40}});  // number 40 was not sent yet
  EXPECT_EQ(Stat("twcc-mismatched"), 4U);
}

TEST_F(ScreamAux, TheTimesOfAReportMayReachIntoASecondPeriodOfItsClock) {
  for (int i = 0; i < 3; ++i) Push();
  ASSERT_EQ(Leave(), 3);
  constexpr auto kPeriod = static_cast<guint64>(rtcp::kTwccPeriod.count());
  Tell({{0, 100, false, kPeriod + GST_SECOND}, {1, 100, false, kPeriod + GST_SECOND}});
  EXPECT_EQ(Stat("packets-acked"), 2U);
  Tell({{2, 100, false, 2 * kPeriod + 1}});  // later than a report can express
  EXPECT_EQ(Stat("packets-acked"), 2U);
}

TEST_F(ScreamAux, NoReportReachesFurtherThanItsFormat) {
  Push();
  ASSERT_EQ(Leave(), 1);
  constexpr guint kMost = rtcp::kMaxTwccPackets;
  Tell({{0}, {kMost - 1}});  // the second packet may have been sent meanwhile
  EXPECT_EQ(Stat("twcc-mismatched"), 0U);
  Tell({{0}, {kMost}});
  EXPECT_EQ(Stat("twcc-mismatched"), 1U);
}

TEST_F(ScreamAux, FindsTheExtensionByItsUriHoweverCapsHaveIt) {
  guint next = 0;
  for (const std::string& extmap :
       {std::string("extmap-14=(string)") + rtcp::kTwccUri,
        std::string("extmap-1=(string)urn:other,extmap-14=(string)<\"\",\"") + rtcp::kTwccUri +
            "\",\"\">",
        std::string("extmap-1=(int)7,extmap-2=(string)<\"\">,extmap-3=(int)<1,2>,") +
            "extmap-14=(string)" + rtcp::kTwccUri,
        std::string("extmap-14=(string)<\"sendrecv\",\"") + rtcp::kTwccUri + "\">"}) {
    const guint64 before = Stat("packets-acked");
    gst_harness_set_src_caps_str(harness.get(), (kRtpCaps + ("," + extmap)).c_str());
    Push(false);
    extension = 14;
    Push();
    extension = kExtension;
    Push();  // its number is in the other extension
    ASSERT_EQ(Leave(), 3);
    Tell({{next++}});
    EXPECT_EQ(Stat("packets-acked"), before + 1) << extmap;
  }
  Tell({{next}});
  EXPECT_EQ(Stat("packets-acked"), 4U);
}

TEST_F(ScreamAux, WarnsOnceInEachRunOfStreamsThatPassBesideIt) {
  const ElementBus bus(element);
  Push();
  ASSERT_EQ(Leave(), 1);
  for (int run = 0; run < 2; ++run) {
    for (int i = 0; i < 3; ++i) Tell({{0, 1200}});
    const auto warnings = bus.Texts(GST_MESSAGE_WARNING);
    ASSERT_EQ(warnings.size(), 1U) << run;
    EXPECT_EQ(warnings[0], "The session reports packets that did not pass screamaux.");
    gst_element_set_state(element, GST_STATE_READY);
    gst_element_set_state(element, GST_STATE_PLAYING);
  }
}

TEST(ScreamAuxSettings, FitASessionWithTransportWideFeedback) {
  int notified = 0;
  const gst::ElementPtr element(
      GST_ELEMENT(gst_object_ref_sink(gst_element_factory_make("screamaux", nullptr))));
  const gst::ElementPtr tx(gst_bin_get_by_name(GST_BIN(element.get()), "screamtx"));
  guint overhead = 0;
  guint64 interval = 0;
  gint ecn = -1;
  g_object_get(tx.get(), "packet-overhead", &overhead, "feedback-interval", &interval, "ecn-mode",
               &ecn, nullptr);
  EXPECT_EQ(overhead, 20U + 8 + 10);  // the headers of IPv4 and UDP, and the tag of SRTP
  EXPECT_EQ(interval, 500 * GST_MSECOND);
  EXPECT_EQ(ecn, 0);
  // screamaux shows the estimate of its screamtx, and also passes its notifications on.
  g_signal_connect(element.get(), "notify::estimated-bitrate",
                   G_CALLBACK(+[](GObject*, GParamSpec*, int* n) { ++*n; }), &notified);
  g_object_notify(G_OBJECT(tx.get()), "estimated-bitrate");
  EXPECT_EQ(notified, 1);
}

TEST_F(ScreamAux, AbsurdReportsDoNoHarm) {
  Push();
  ASSERT_EQ(Leave(), 1);
  Tell({});
  Tell({{40000}, {70000}, {4000000000U}});
  Tell(std::vector<Told>(1000, Told{12345, 0, true, 0}));
  for (const char* text : {"RTPTWCCPackets;", "RTPTWCCPackets, packets=(string)none;",
                           "RTPTWCCPackets, packets=(int)7;", "Another, packets=(int)7;"})
    gst_harness_push_upstream_event(
        harness.get(),
        gst_event_new_custom(GST_EVENT_CUSTOM_UPSTREAM, gst_structure_from_string(text, nullptr)));
  EXPECT_EQ(Stat("packets-acked"), 0U);
  Tell({{0}});
  EXPECT_EQ(Stat("packets-acked"), 1U);
}

TEST_F(ScreamAux, MeasuresDelayInTicksOfTheReport) {
  // The two packets of each report arrive 21 ms apart. If the element read the arrival times in
  // units of 1/1024 s, the first packet would seem to arrive almost half a millisecond too early.
  constexpr guint64 kTick = 250 * GST_USECOND;
  guint number = 0;
  for (int report = 0; report < 8; ++report) {
    std::vector<Told> told;
    for (guint64 i = 0; i < 2; ++i) {
      time.Advance(11 * GST_MSECOND);
      Push();
      ASSERT_EQ(Leave(1), 1);
      // The packets of the last report are delayed by one tick more than those before.
      const guint64 delay = 40 * kTick + (report == 7 ? kTick : 0);
      // Report() adds i ms.
      told.push_back({number++, 100, false, time.now() + delay - i * GST_MSECOND});
    }
    Tell(told);
  }
  EXPECT_NEAR(static_cast<double>(Stat("queue-delay")), kTick, 0.15 * kTick);
}

TEST_F(ScreamAux, ForgetsTheExtensionWhereNewCapsHaveNone) {
  Push();
  ASSERT_EQ(Leave(), 1);
  gst_harness_set_src_caps_str(harness.get(), kRtpCaps);
  Push();  // with these caps, the extension's id has another meaning
  ASSERT_EQ(Leave(), 1);
  SetCaps();
  Push();
  ASSERT_EQ(Leave(), 1);
  Tell({{0}, {1}, {2}});  // only two packets have a number
  EXPECT_EQ(Stat("packets-acked"), 2U);
}

TEST_F(ScreamAux, ReportsThatAnAttackerMakesUpMoveNothing) {
  for (int i = 0; i < 8; ++i) Push();
  const int sent = Leave();
  ASSERT_GT(sent, 2);
  const guint64 target = Stat("target-bitrate");
  // These reports are about packets that were never sent, about packets with wrong sizes, or
  // contain impossible arrival times.
  for (guint first : {100U, 20000U, 65000U}) Tell({{first}, {first + 1}, {first + 2}});
  Tell({{0, 1200}, {1, 1200}});
  for (guint64 arrival : {guint64{1}, guint64{12 * 24 * 3600} * GST_SECOND, G_MAXUINT64 / 2}) {
    Told t{0};
    t.arrival = arrival;
    Tell({t});
  }
  for (int i = 0; i < 100; ++i) Tell({{0}, {1}});  // the same report many times
  EXPECT_LE(Stat("packets-acked"), 2U);
  EXPECT_EQ(Stat("packets-lost"), 0U);
  EXPECT_LE(Stat("target-bitrate"), 2 * target);
}

TEST(ScreamAuxPads, AreNamedAfterTheSession) {
  const gst::ElementPtr element(
      GST_ELEMENT(gst_object_ref_sink(gst_element_factory_make("screamaux", nullptr))));
  const auto has = [&](const char* name) {
    return gst::PadPtr(gst_element_get_static_pad(element.get(), name)) != nullptr;
  };
  EXPECT_TRUE(has("sink") && has("src"));
  g_object_set(element.get(), "session", 3, nullptr);
  EXPECT_TRUE(has("sink_3") && has("src_3"));
  EXPECT_FALSE(has("sink") || has("src"));
  g_object_set(element.get(), "session", 0, nullptr);
  EXPECT_TRUE(has("sink_0") && has("src_0"));
  g_object_set(element.get(), "session", -1, nullptr);
  EXPECT_TRUE(has("sink") && has("src"));
  EXPECT_EQ(element->numpads, 2);
}

TEST_F(ScreamAux, GoesOnWithTheSessionsNumbersAfterAPauseInReady) {
  Push();
  ASSERT_EQ(Leave(), 1);
  Restart();
  Push();
  ASSERT_EQ(Leave(), 1);
  Tell({{1}});
  EXPECT_EQ(Stat("packets-acked"), 1U);
}

TEST_F(ScreamAux, GivesNoNumberToAPacketThatTheSessionRefuses) {
  Push();
  ASSERT_EQ(Leave(), 1);
  gst_pad_set_active(harness->sinkpad, FALSE);
  Push();
  ASSERT_TRUE(
      Eventually([&] { return gst_harness_push(harness.get(), NewRtp({})) == GST_FLOW_FLUSHING; }));
  gst_pad_set_active(harness->sinkpad, TRUE);
  Restart();
  Push();
  ASSERT_EQ(Leave(), 1);
  Tell({{1}});
  EXPECT_EQ(Stat("packets-acked"), 1U);
}

TEST_F(ScreamAux, CountsTheReportsOfEachRunAlone) {
  Push();
  ASSERT_EQ(Leave(), 1);
  Tell({{0}});
  EXPECT_EQ(Stat("twcc-reports"), 1U);
  gst_element_set_state(element, GST_STATE_READY);
  gst_element_set_state(element, GST_STATE_PLAYING);
  EXPECT_EQ(Stat("twcc-reports"), 0U);
  EXPECT_EQ(Stat("twcc-packets"), 0U);
}

TEST_F(ScreamAux, TellsTheEncoderItsTargetAndHasTheSendersProperties) {
  g_object_set(element, "max-bitrate", 3000000U, "start-bitrate", 2000000U, nullptr);
  guint bps = 0;
  g_object_get(element, "max-bitrate", &bps, nullptr);
  EXPECT_EQ(bps, 3000000U);
  Push();
  Leave();
  bool told = false;
  while (EventPtr event{gst_harness_try_pull_upstream_event(harness.get())}) {
    GstLidarTargetBitrate target{};
    told = told || gst_lidar_event_parse_target_bitrate(event.get(), &target);
  }
  EXPECT_TRUE(told);
}

/// The sender and the receiver are GStreamer's own rtpbins. screamaux is linked before the sender's
/// rtpbin, or put into that rtpbin by the signal request-aux-sender.
class ScreamAuxWithRtpbin : public ::testing::TestWithParam<bool> {};
TEST_P(ScreamAuxWithRtpbin, TheReceiversReportsMoveTheTarget) {
  const bool inside = GetParam();
  const std::string caps = std::string(
                               "application/x-rtp,media=video,clock-rate=90000,"
                               "encoding-name=JPEG,payload=26,extmap-1=(string)") +
                           rtcp::kTwccUri;
  const std::array<guint16, 3> ports{FreePort(), FreePort(), FreePort()};
  const auto at = [&](const char* element, std::size_t offset) {
    const std::string port = " port=" + std::to_string(ports.at(offset)) + " ";
    if (std::string(element) == "udpsrc") return "udpsrc" + port;
    return "udpsink host=127.0.0.1 sync=false async=false" + port;
  };
  Pipeline pipeline(
      "rtpbin name=tx rtp-profile=avpf rtpbin name=rx rtp-profile=avpf "
      "videotestsrc is-live=true ! video/x-raw,format=I420,width=160,height=120,framerate=30/1 ! "
      "jpegenc ! rtpjpegpay mtu=1000 ! capsfilter name=media caps=\"" +
      caps + "\" " +
      (inside ? "" : "! screamaux name=aux start-bitrate=4000000 ! tx.send_rtp_sink_0 ") +
      at("udpsrc", 0) + "! " + caps +
      " ! rx.recv_rtp_sink_0 fakesink name=end sync=false async=false " + at("udpsrc", 1) +
      "! rx.recv_rtcp_sink_0 rx.send_rtcp_src_0 ! " + at("udpsink", 2) + at("udpsrc", 2) +
      "! tx.recv_rtcp_sink_0 " + at("udpsink", 0) + "name=rtp " + at("udpsink", 1) + "name=rtcp");
  const auto tx = pipeline.Get("tx");
  g_signal_connect(tx.get(), "request-aux-sender",
                   G_CALLBACK(+[](GstElement*, guint session, const bool* wanted) -> GstElement* {
                     if (!*wanted) return nullptr;
                     GstElement* aux = gst_element_factory_make("screamaux", "aux");
                     g_object_set(aux, "session", session, "start-bitrate", 4000000U, nullptr);
                     return aux;
                   }),
                   const_cast<bool*>(&inside));
  if (inside) {
    ASSERT_TRUE(
        gst_element_link_pads(pipeline.Get("media").get(), "src", tx.get(), "send_rtp_sink_0"));
  }
  ASSERT_TRUE(gst_element_link_pads(tx.get(), "send_rtp_src_0", pipeline.Get("rtp").get(), "sink"));
  ASSERT_TRUE(
      gst_element_link_pads(tx.get(), "send_rtcp_src_0", pipeline.Get("rtcp").get(), "sink"));
  const auto end = pipeline.Get("end");
  g_signal_connect(pipeline.Get("rx").get(), "pad-added",
                   G_CALLBACK(+[](GstElement*, GstPad* pad, GstElement* sink) {
                     const gst::PadPtr to(gst_element_get_static_pad(sink, "sink"));
                     gst_pad_link(pad, to.get());
                   }),
                   end.get());
  pipeline.Play();
  const auto aux = pipeline.Get("aux");
  ASSERT_TRUE(aux);
  EXPECT_TRUE(Eventually([&] { return Stats(aux.get())["packets-acked"] >= 40; }));
  const Stats stats(aux.get());
  EXPECT_GT(stats["feedback-accepted"], 2U);
  EXPECT_EQ(stats["feedback-ignored"], 0U);
  EXPECT_EQ(stats["twcc-mismatched"], 0U);
}
INSTANTIATE_TEST_SUITE_P(Place, ScreamAuxWithRtpbin, ::testing::Bool(),
                         [](const auto& i) { return i.param ? "Inside" : "Before"; });

}  // namespace
}  // namespace lidar::test
