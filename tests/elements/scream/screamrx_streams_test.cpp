// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of the streams of a screamrx: how they end, the reports of their sender, and their pads.
#include "tests/elements/scream/screamrx_fixture.h"
#include "tests/support/element_bus.h"

namespace lidar::test {
namespace {

TEST_F(ScreamRx, EndsWhenEveryStreamSaidGoodbye) {
  Start();
  Rtp other;
  other.ssrc = 0x5678;
  ASSERT_EQ(Push({}), GST_FLOW_OK);
  ASSERT_EQ(Push(other), GST_FLOW_OK);
  EXPECT_EQ(PushBye({0x1234}), GST_FLOW_OK);
  EXPECT_EQ(PushBye({0x9999}), GST_FLOW_OK);  // for an unknown SSRC
  EXPECT_EQ(Push(other), GST_FLOW_OK);
  EXPECT_EQ(PushBye({0x5678}), GST_FLOW_EOS);
  EXPECT_EQ(Push(other), GST_FLOW_EOS);
  EXPECT_EQ(Stats(element)["goodbyes"], 2U);
  bool eos = false;
  while (EventPtr event{gst_harness_try_pull_event(rtp.get())})
    eos = eos || GST_EVENT_TYPE(event.get()) == GST_EVENT_EOS;
  EXPECT_TRUE(eos);
  EXPECT_EQ(Passed(), 3U);
}

TEST_F(ScreamRx, GoesOnBehindAFlushAfterTheEnd) {
  Start();
  ASSERT_EQ(Push({}), GST_FLOW_OK);
  ASSERT_EQ(PushBye({0x1234}), GST_FLOW_EOS);
  Flush(rtp.get());
  EXPECT_EQ(Push({}), GST_FLOW_OK);
}

TEST_F(ScreamRx, EndsWithASenderThatRestartedThoughItsFirstSsrcNeverSaidGoodbye) {
  Start();
  Rtp next;
  next.ssrc = 0x5678;
  ASSERT_EQ(Push({}), GST_FLOW_OK);
  time.Settle();
  time.Advance(3 * GST_SECOND);
  ASSERT_EQ(Push(next), GST_FLOW_OK);
  EXPECT_EQ(PushBye({0x5678}), GST_FLOW_OK);  // the first stream may continue
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
  EXPECT_EQ(Stats(element)["sender-report-age"], 0U);
  ASSERT_EQ(Push({}, GST_LIDAR_ECN_ECT1, "10.0.0.1"), GST_FLOW_OK);
  rtcp::SenderReport report;
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
  report.time_ms += 1000;  // the time wraps
  report.packets_lost = 12;
  ASSERT_EQ(PushReport(report), GST_FLOW_OK);
  EXPECT_EQ(Stats(element)["sender-packets-lost"], 12U);
  EXPECT_EQ(Passed(), 1U);
  time.Advance(11 * GST_SECOND);
  report.time_ms = 5;  // the sender was restarted
  report.packets_lost = 0;
  ASSERT_EQ(PushReport(report), GST_FLOW_OK);
  EXPECT_EQ(Stats(element)["sender-packets-lost"], 0U);
}

TEST_F(ScreamRx, ShowsEachFigureOfTheSendersReportByItsName) {
  Start();
  ASSERT_EQ(Push({}, GST_LIDAR_ECN_ECT1, "10.0.0.1"), GST_FLOW_OK);
  rtcp::SenderReport report;
  report.ssrc = 0x1234;
  report.target_bitrate = DataRate::BitsPerSecond(1001);
  report.estimated_capacity = DataRate::BitsPerSecond(1002);
  report.sent_bitrate = DataRate::BitsPerSecond(1003);
  report.ref_wnd = DataSize::Bytes(1004);
  report.bytes_in_flight = DataSize::Bytes(1005);
  report.queue_delay = std::chrono::microseconds(1006);
  report.rtt = std::chrono::microseconds(1007);
  report.sender_queue_delay = std::chrono::microseconds(1008);
  report.packets_sent = 1009;
  report.packets_lost = 1010;
  report.packets_ce = 1011;
  report.packets_dropped = 1012;
  ASSERT_EQ(PushReport(report), GST_FLOW_OK);
  const Stats stats(element);
  EXPECT_EQ(stats["sender-target-bitrate"], 1001U);
  EXPECT_EQ(stats["sender-estimated-capacity"], 1002U);
  EXPECT_EQ(stats["sender-sent-bitrate"], 1003U);
  EXPECT_EQ(stats["sender-ref-wnd"], 1004U);
  EXPECT_EQ(stats["sender-bytes-in-flight"], 1005U);
  EXPECT_EQ(stats["sender-queue-delay"], 1006 * GST_USECOND);
  EXPECT_EQ(stats["sender-rtt"], 1007 * GST_USECOND);
  EXPECT_EQ(stats["sender-own-queue-delay"], 1008 * GST_USECOND);
  EXPECT_EQ(stats["sender-packets-sent"], 1009U);
  EXPECT_EQ(stats["sender-packets-lost"], 1010U);
  EXPECT_EQ(stats["sender-packets-ce"], 1011U);
  EXPECT_EQ(stats["sender-packets-dropped"], 1012U);
}

TEST_F(ScreamRx, BelievesNoReportThatIsOldOrOfSomebodyElse) {
  Start();
  ASSERT_EQ(Push({}, GST_LIDAR_ECN_ECT1, "10.0.0.1"), GST_FLOW_OK);
  rtcp::SenderReport report;
  report.ssrc = 0x1234;
  report.time_ms = 5000;
  ASSERT_EQ(PushReport(report), GST_FLOW_OK);
  ASSERT_EQ(PushReport(report), GST_FLOW_OK);  // the same report again
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
  rtcp::SenderReport report;
  report.ssrc = 0x1234;
  auto bytes = rtcp::BuildSenderReport(report);
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

TEST_F(ScreamRx, GivesEachStreamAPadOfItsOwnWithPtMap) {
  SetPtMap(
      "96=(string)\"application/x-rtp,media=application,clock-rate=90000,encoding-name=TEST\","
      "97=(string)\"application/x-rtp,media=video,clock-rate=90000,encoding-name=H264\"");
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
    Rtp repair;  // its payload type is not in pt-map, so it shares the first stream's pad
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
  gst_harness_set_src_caps_str(rtp.get(), kVideoCaps);
  const CapsPtr first(gst_pad_get_current_caps(rtp->sinkpad));
  EXPECT_STREQ(gst_structure_get_string(gst_caps_get_structure(first.get(), 0), "encoding-name"),
               "TEST");
}

TEST_F(ScreamRx, ARestartedSenderGetsThePadOfItsEarlierSsrc) {
  StartAndOutliveByes("application/x-rtp,media=application");
  const auto passes = [&](guint32 ssrc, const char* host) {
    Rtp r;
    r.ssrc = ssrc;
    for (; r.seq < 6; ++r.seq) EXPECT_EQ(Push(r, GST_LIDAR_ECN_ECT1, host), GST_FLOW_OK);
    const char* how = "not";
    while (const BufferPtr buffer{gst_harness_try_pull(rtp.get())}) {
      if (*how == 'n') how = "on";
      if (GST_BUFFER_FLAG_IS_SET(buffer.get(), GST_BUFFER_FLAG_DISCONT)) how = "anew";
    }
    return how;
  };
  EXPECT_STREQ(passes(1, "10.0.0.1"), "on");
  EXPECT_STREQ(passes(2, "10.0.0.1"), "not") << "a second stream";
  EXPECT_EQ(PushBye({1}, "10.0.0.1"), GST_FLOW_OK);
  EXPECT_STREQ(passes(3, "10.0.0.1"), "anew");
  const CapsPtr caps(gst_pad_get_current_caps(rtp->sinkpad));
  guint ssrc = 0;
  gst_structure_get_uint(gst_caps_get_structure(caps.get(), 0), "ssrc", &ssrc);
  EXPECT_EQ(ssrc, 3U);
  EXPECT_STREQ(passes(1, "10.0.0.1"), "not") << "its pad is taken";
  time.Settle();
  time.Advance(20 * GST_SECOND);
  EXPECT_STREQ(passes(4, "10.0.0.2"), "anew") << "another peer";
}

TEST_F(ScreamRx, RestartedStreamsKeepTheirOrderOfPads) {
  StartAndOutliveByes("application/x-rtp,media=application");
  const auto push = [&](guint32 ssrc) {
    Rtp r;
    r.ssrc = ssrc;
    for (; r.seq < 6; ++r.seq) EXPECT_EQ(Push(r), GST_FLOW_OK) << ssrc;
  };
  push(20);  // this stream gets the pad `src`
  push(10);
  Harness second(gst_harness_new_with_element(element, nullptr, "src_10"));
  push(10);
  const auto received = [&] {
    return std::pair(gst_harness_buffers_received(rtp.get()),
                     gst_harness_buffers_received(second.get()));
  };
  EXPECT_EQ(received(), std::pair(6U, 6U));
  EXPECT_EQ(PushBye({10, 20}), GST_FLOW_OK);
  push(30);
  EXPECT_EQ(received(), std::pair(12U, 6U));
  push(40);
  EXPECT_EQ(received(), std::pair(12U, 12U));
  push(10);  // its pad now belongs to another stream
  EXPECT_EQ(received(), std::pair(12U, 12U));
  EXPECT_TRUE(gst::PadPtr(gst_element_get_static_pad(element, "src_11")));
}

TEST_F(ScreamRx, ARestartedStreamGetsAPadThatHadItsPayloadType) {
  SetPtMap(
      "96=(string)\"application/x-rtp,media=application,clock-rate=90000,encoding-name=TEST\","
      "97=(string)\"application/x-rtp,media=video,clock-rate=90000,encoding-name=H264\"");
  g_object_set(element, "eos-on-bye", FALSE, nullptr);
  Start();
  gst_harness_set_sink_caps_str(rtp.get(), "application/x-rtp");
  const auto push = [&](guint32 ssrc, guint8 type) {
    Rtp r;
    r.ssrc = ssrc;
    r.payload_type = type;
    for (; r.seq < 3; ++r.seq) EXPECT_EQ(Push(r), GST_FLOW_OK) << ssrc;
  };
  push(1, 96);  // this stream gets the pad `src`
  push(2, 97);
  Harness video(gst_harness_new_with_element(element, nullptr, "src_2"));
  push(2, 97);
  const guint before = gst_harness_buffers_received(video.get());
  EXPECT_EQ(PushBye({1, 2}), GST_FLOW_OK);
  push(4, 97);
  EXPECT_EQ(Passed(), 3U) << "src would take the caps, but had another type";
  EXPECT_EQ(gst_harness_buffers_received(video.get()), before + 3);
  push(3, 96);
  EXPECT_EQ(Passed(), 6U);
}

TEST_F(ScreamRx, AStreamThatThePadOfAnEndedOneRefusesGetsItsOwn) {
  StartAndOutliveByes("application/x-rtp,ssrc=(uint)1");
  Rtp r;
  r.ssrc = 1;
  for (; r.seq < 6; ++r.seq) EXPECT_EQ(Push(r), GST_FLOW_OK);
  EXPECT_EQ(PushBye({1}), GST_FLOW_OK);
  r.ssrc = 2;
  for (r.seq = 0; r.seq < 5; ++r.seq) Push(r);
  EXPECT_EQ(Passed(), 6U);
  const auto has = [&](const char* name) {
    return gst::PadPtr(gst_element_get_static_pad(element, name)) != nullptr;
  };
  EXPECT_TRUE(has("src_2"));
  PushBye({2});
  r.ssrc = 3;
  Push(r);
  EXPECT_TRUE(has("src_3")) << "nobody took src_2";
}

TEST_F(ScreamRx, TheStreamsOfAListLeaveByTheirPadsBehindTheirCapsUntilTheLastGoodbye) {
  SetPtMap(
      "96=(string)\"application/x-rtp,media=application,clock-rate=90000,encoding-name=TEST\"");
  Start();
  gst_harness_set_sink_caps_str(rtp.get(), "application/x-rtp,media=application");
  guint16 seq = 0;
  const auto push = [&](const std::vector<guint32>& ssrcs, const std::vector<guint32>& byes) {
    GstBufferList* list = gst_buffer_list_new();
    for (guint16 i = 0; i < 2; ++i)
      for (const guint32 ssrc : ssrcs) {
        Rtp r;
        r.ssrc = ssrc;
        r.seq = seq++;
        gst_buffer_list_add(list, NewRtp(r));
      }
    if (!byes.empty()) gst_buffer_list_insert(list, 1, FromBytes(gst::BuildBye(byes)));
    return gst_pad_push_list(rtp->srcpad, list);
  };
  EXPECT_EQ(push({1}, {}), GST_FLOW_OK);
  std::vector<GstEventType> events;
  while (const EventPtr event{gst_harness_try_pull_event(rtp.get())})
    events.push_back(GST_EVENT_TYPE(event.get()));
  EXPECT_EQ(events,
            (std::vector<GstEventType>{GST_EVENT_STREAM_START, GST_EVENT_CAPS, GST_EVENT_SEGMENT}));
  push({2}, {});
  const Harness second(gst_harness_new_with_element(element, nullptr, "src_2"));
  EXPECT_EQ(push({2, 1}, {2}), GST_FLOW_OK);
  EXPECT_EQ(Passed(), 4U);
  EXPECT_EQ(gst_harness_buffers_received(second.get()), 2U);
  EXPECT_EQ(push({1}, {1, 2}), GST_FLOW_EOS);
  EXPECT_EQ(Passed(), 5U) << "nothing behind the last goodbye";
}

TEST_F(ScreamRx, MarksTheFirstPacketOfARestartedSenderNotTheBufferThatOthersHold) {
  StartAndOutliveByes("application/x-rtp,media=application");
  ASSERT_EQ(Push({}), GST_FLOW_OK);
  ASSERT_EQ(PushBye({0x1234}), GST_FLOW_OK);
  Rtp r;
  r.ssrc = 2;
  const BufferPtr held(NewRtp(r));
  ASSERT_EQ(gst_harness_push(rtp.get(), gst_buffer_ref(held.get())), GST_FLOW_OK);
  gst_buffer_unref(gst_harness_pull(rtp.get()));
  const BufferPtr passed(gst_harness_pull(rtp.get()));
  EXPECT_TRUE(GST_BUFFER_FLAG_IS_SET(passed.get(), GST_BUFFER_FLAG_DISCONT));
  EXPECT_FALSE(GST_BUFFER_FLAG_IS_SET(held.get(), GST_BUFFER_FLAG_DISCONT));
}

TEST_F(ScreamRx, RtcpIsNoStreamOfPtMap) {
  SetPtMap(
      "0=(string)\"application/x-rtp,media=audio,clock-rate=8000,encoding-name=PCMU\","
      "96=(string)\"application/x-rtp,media=application,clock-rate=90000,encoding-name=TEST\"");
  Start();
  gst_harness_set_sink_caps_str(rtp.get(), "application/x-rtp,media=application");
  const std::vector<std::uint8_t> receiver_report{0x80, 201, 0, 1, 0, 0, 0x12, 0x34};
  EXPECT_EQ(gst_harness_push(rtp.get(), FromBytes(receiver_report)), GST_FLOW_OK);
  EXPECT_EQ(GST_ELEMENT(element)->numsrcpads, 2);
  ASSERT_EQ(Push({}), GST_FLOW_OK);
  EXPECT_EQ(gst_harness_push(rtp.get(), FromBytes(receiver_report)), GST_FLOW_OK);
  EXPECT_EQ(Passed(), 1U) << "the media";
}

TEST_F(ScreamRx, AFlushReachesAPadThatIsJustBeingAdded) {
  SetPtMap("97=(string)\"application/x-rtp,media=video,clock-rate=90000,encoding-name=H264\"");
  Start();
  gst_harness_set_sink_caps_str(rtp.get(), "application/x-rtp,media=application");
  struct Added {
    GstPad* from;
    Harness harness;
  } added{rtp->srcpad, nullptr};
  g_signal_connect(element, "pad-added", G_CALLBACK(+[](GstElement* e, GstPad* pad, Added* a) {
                     if (!g_str_has_prefix(GST_PAD_NAME(pad), "src_")) return;
                     a->harness.reset(gst_harness_new_with_element(e, nullptr, GST_PAD_NAME(pad)));
                     gst_pad_push_event(a->from, gst_event_new_flush_start());
                   }),
                   &added);
  Rtp camera;
  camera.payload_type = 97;
  EXPECT_EQ(Push(camera), GST_FLOW_FLUSHING);
  ASSERT_TRUE(added.harness);
  EXPECT_EQ(gst_harness_buffers_received(added.harness.get()), 0U);
  gst_harness_push_event(rtp.get(), gst_event_new_flush_stop(TRUE));
  gst_harness_push_event(rtp.get(), NewSegment());
  ++camera.seq;
  EXPECT_EQ(Push(camera), GST_FLOW_OK);
  EXPECT_EQ(gst_harness_buffers_received(added.harness.get()), 1U);
}

TEST_F(ScreamRx, MakesSoManyPadsAtMostAndForgetsThemWhenItStops) {
  SetPtMap(
      "72=(string)\"application/x-rtp,media=video,clock-rate=90000,encoding-name=H264\","
      "97=(string)\"application/x-rtp,media=video,clock-rate=90000,encoding-name=H264\"");
  const ElementBus bus(element);
  Start();
  for (int round = 0; round < 2; ++round) {
    Rtp camera;
    camera.payload_type = 97;
    camera.size = 10;
    // With a marker bit, a packet of type 72 looks like RTCP. Therefore pt-map may not have this
    // type.
    camera.payload_type = 72;
    Push(camera);
    camera.payload_type = 97;
    for (camera.ssrc = 1; camera.ssrc < 1'100; ++camera.ssrc) Push(camera);
    const BufferPtr refused(NewRtp(camera));
    gst_harness_push(rtp.get(), gst_buffer_ref(refused.get()));
    EXPECT_EQ(GST_MINI_OBJECT_REFCOUNT_VALUE(refused.get()), 1) << "it is freed";
    EXPECT_EQ(Passed(), 2 * static_cast<guint>(round) + 2);  // `src` passes the first stream, too
    EXPECT_EQ(GST_ELEMENT(element)->numsrcpads, 1'024);      // including rtcp_src and `src`
    EXPECT_EQ(Stats(element)["packets-foreign"], 77U);
    const auto told = bus.Texts(GST_MESSAGE_WARNING);
    EXPECT_EQ(std::count(told.begin(), told.end(), "More than 1024 streams arrive."), 1)
        << "once a run";
    gpointer pad = gst_element_get_static_pad(element, "src_2");
    ASSERT_TRUE(pad);
    g_object_add_weak_pointer(G_OBJECT(pad), &pad);
    gst_object_unref(pad);
    gst_element_set_state(element, GST_STATE_NULL);
    EXPECT_FALSE(pad) << "nothing keeps a pad that is gone";
    EXPECT_EQ(GST_ELEMENT(element)->numsrcpads, 2);
    gst_harness_play(rtp.get());
  }
}

TEST_F(ScreamRx, WarnsOfWhatIsWrongWithPtMapAndOfAStreamThatNobodyTakes) {
  SetPtMap(
      "72=(string)\"application/x-rtp,media=video,clock-rate=90000,encoding-name=H264\","
      "97=(string)\"application/x-rtp,media=video,clock-rate=90000,encoding-name=H264\","
      "98=(string)\"application/x-rtp,clock-rate=[1,2]\","
      "200=(string)\"application/x-rtp,media=video\",lidar=(int)96");
  const ElementBus bus(element);
  Start();
  std::string texts;
  const auto warnings = [&] {
    const auto told = bus.Texts(GST_MESSAGE_WARNING);
    for (const std::string& text : told) texts += text + "\n";
    return told.size();
  };
  gst_harness_set_sink_caps_str(rtp.get(), "application/x-rtp,media=application");
  for (int run = 0; run < 2; ++run) {
    EXPECT_EQ(warnings(), 4U) << run;
    for (const char* fault : {"72 looks like RTCP", "98 must have fixed caps",
                              "200 is not a payload type", "lidar is not a payload type"})
      EXPECT_NE(texts.find(fault), std::string::npos) << texts;
    texts.clear();
    for (guint16 seq = 0; seq < 4; ++seq) {
      Rtp camera;
      camera.ssrc = 0x5678;
      camera.payload_type = 97;
      camera.seq = seq;
      EXPECT_EQ(Push(camera), GST_FLOW_OK);
    }
    EXPECT_EQ(warnings(), 1U) << run;
    EXPECT_NE(texts.find("payload type 97 (SSRC 22136)"), std::string::npos) << texts;
    gst_element_set_state(element, GST_STATE_NULL);
    gst_harness_play(rtp.get());
  }
}

}  // namespace
}  // namespace lidar::test
