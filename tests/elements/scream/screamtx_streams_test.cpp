// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of several streams in one screamtx: their shares, their companions, and pads that are added
// and released.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "tests/elements/scream/screamtx_fixture.h"

namespace lidar::test {
namespace {

/// Requests the pad sink_1 of screamtx. The segment of its stream begins at `start`.
Harness AddVideoFrom(GstElement* element, GstClockTime start) {
  Harness video(gst_harness_new_with_element(element, "sink_1", nullptr));
  gst_harness_set_src_caps_str(video.get(), kVideoCaps);
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  segment.start = segment.time = segment.position = start;
  EXPECT_TRUE(gst_harness_push_event(video.get(), gst_event_new_segment(&segment)));
  return video;
}

/// Pushes frame `i` of the stream with SSRC 0x5678. The frame has one packet.
void PushSmallFrame(GstHarness* stream, int i) {
  Rtp r;
  r.ssrc = 0x5678;
  r.seq = static_cast<guint16>(i);
  r.timestamp = static_cast<guint32>(i);
  r.marker = true;
  ASSERT_EQ(gst_harness_push(stream, NewRtp(r)), GST_FLOW_OK);
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
    PushSmallFrame(second.get(), i);
    for (int k = 0; k < 2; ++k) {
      time.Advance(5 * GST_MSECOND);
      Acknowledge(i % 4 == 0 ? Ecn::kCe : Ecn::kEct1);
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
class ScreamTxWith : public ScreamTx, public ::testing::WithParamInterface<Companion> {
 protected:
  /// Sends 400 packets in four seconds, and a packet of the companion with each.
  void SendBoth() {
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
  }
};
TEST_P(ScreamTxWith, LeavesTheEncoderWhatItsCompanionDoesNotTake) {
  g_object_set(element, "start-bitrate", 4'000'000, "min-bitrate", 4'000'000, "max-bitrate",
               4'000'000, nullptr);
  Start();
  SendBoth();
  const GstLidarTargetBitrate target = NextTarget(rtp.get());
  EXPECT_EQ(target.ssrc, 0x1234U);
  EXPECT_NEAR(target.bitrate, 4'000'000 * 1188.0 / 1228 / 2, 40'000);
  EXPECT_EQ(Stats(element)["packets-lost"], 0U);
}
TEST_P(ScreamTxWith, KeepsTheBoundsOfTheEncoderWhereItsCompanionTakesMore) {
  g_object_set(element, "start-bitrate", 4'000'000, nullptr);
  Start();
  const GstLidarBitrateBounds bounds{1'000'000, 8'000'000, 0};
  ASSERT_TRUE(gst_harness_push_event(rtp.get(), gst_lidar_event_new_bitrate_bounds(&bounds)));
  SendBoth();
  const GstLidarTargetBitrate target = NextTarget(rtp.get());
  EXPECT_NEAR(target.min_bitrate, 1'000'000, 30'000);
  EXPECT_NEAR(target.max_bitrate, 8'000'000, 240'000);
}
INSTANTIATE_TEST_SUITE_P(Companions, ScreamTxWith,
                         ::testing::Values(Companion{"rtx", 0x5678, 97},
                                           Companion{"ulpfec", 0x1234, 122},
                                           Companion{"second_ssrc", 0x5678, 96}),
                         [](const auto& i) { return i.param.name; });

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

TEST_F(ScreamTx, APadThatComesAndGoesWhilePlayingTakesItsShareAndLeavesIt) {
  g_object_set(element, "start-bitrate", 4'000'000, "min-bitrate", 10'000, "max-bitrate", 4'000'000,
               nullptr);
  Start();
  PushFrame(0, 1);
  Acknowledge();
  EXPECT_NEAR(static_cast<double>(Stats(element)["target-bitrate"]), 4e6, 1);
  for (int round = 0; round < 3; ++round) {
    Harness second(gst_harness_new_with_element(element, "sink_1", nullptr));
    gst_harness_set_src_caps_str(second.get(), kVideoCaps);
    Rtp r;
    r.ssrc = 0x5678;
    r.marker = true;
    // More packets than the window allows, so that some wait in the queue.
    for (guint16 i = 0; i < 30; ++i) {
      r.seq = i;
      ASSERT_EQ(gst_harness_push(second.get(), NewRtp(r)), GST_FLOW_OK);
    }
    Collect();
    EXPECT_GT(Stats(element)["queued-bytes"], 0U);
    second.reset();  // releases its pad
    EXPECT_FALSE(gst::PadPtr(gst_element_get_static_pad(element, "sink_1")));
    EXPECT_EQ(Stats(element)["queued-bytes"], 0U);
    time.Advance(500 * GST_MSECOND);
    Acknowledge();
    PushFrame(static_cast<guint32>(1 + round) * 900, 1);
    time.Advance(500 * GST_MSECOND);
    Acknowledge();
    EXPECT_EQ(sent.back().ssrc, 0x1234U);
    EXPECT_NEAR(static_cast<double>(Stats(element)["target-bitrate"]), 4e6, 4e6 / 2);
  }
}

TEST_F(ScreamTx, PadsThatAreAskedForByAllAtOnceAreGivenOnce) {
  // Requests the pads without gst_element_request_pad(), because that function itself checks first
  // whether a name is taken.
  GstElementClass* klass = GST_ELEMENT_GET_CLASS(element);
  GstPadTemplate* templ = gst_element_class_get_pad_template(klass, "sink_%u");
  std::atomic<int> given{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&, i] {
      for (int k = 0; k < 200; ++k) {
        const std::string name = "sink_" + std::to_string(i % 2 == 0 ? k : 1000 * i + k);
        if (klass->request_new_pad(element, templ, name.c_str(), nullptr) != nullptr) ++given;
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(given, 3 * 200);
  EXPECT_EQ(GST_ELEMENT(element)->numsinkpads, 3 * 200 + 1);
  EXPECT_EQ(gst_child_proxy_get_children_count(GST_CHILD_PROXY(element)), 3U * 200);
  for (int i = 0; i < 3 * 200; ++i) {
    GObject* pad = gst_child_proxy_get_child_by_index(GST_CHILD_PROXY(element), 0);
    gst_element_release_request_pad(element, GST_PAD(pad));
    g_object_unref(pad);
  }
  EXPECT_EQ(GST_ELEMENT(element)->numsinkpads, 1);
}

TEST_F(ScreamTx, HasNoChildBehindItsLastPad) {
  auto* proxy = GST_CHILD_PROXY(element);
  EXPECT_EQ(gst_child_proxy_get_child_by_index(proxy, 0), nullptr);
  Start();
  EXPECT_EQ(gst_child_proxy_get_children_count(proxy), 1U);
  const std::unique_ptr<GObject, gst::GObjectUnref> child(
      gst_child_proxy_get_child_by_index(proxy, 0));
  EXPECT_EQ(child.get(), G_OBJECT(gst::PadPtr(gst_pad_get_peer(rtp->srcpad)).get()));
  EXPECT_EQ(gst_child_proxy_get_child_by_index(proxy, 1), nullptr);
}

TEST_F(ScreamTx, TellsOfEachPadThatComesAndGoes) {
  std::string told;
  const auto note = +[](GstChildProxy*, GObject* child, const gchar* name, std::string* to) {
    EXPECT_STREQ(GST_PAD_NAME(child), name);
    *to += std::string(name) + " ";
  };
  g_signal_connect(element, "child-added", G_CALLBACK(note), &told);
  g_signal_connect(element, "child-removed", G_CALLBACK(note), &told);
  const gst::PadPtr first(gst_element_request_pad_simple(element, "sink_3"));
  const gst::PadPtr second(gst_element_request_pad_simple(element, "sink_%u"));
  EXPECT_EQ(told, "sink_3 sink_4 ");
  gst_element_release_request_pad(element, first.get());
  EXPECT_EQ(told, "sink_3 sink_4 sink_3 ");
  gst_element_release_request_pad(element, second.get());
  EXPECT_EQ(told, "sink_3 sink_4 sink_3 sink_4 ");
}

TEST_F(ScreamTx, TakesTheSourceAndThePayloadTypeOfItsMediaFromTheCaps) {
  Start((std::string(kRtpCaps) + ",ssrc=(uint)77").c_str());
  const auto targets = Targets(rtp.get());
  ASSERT_GE(targets.size(), 1U);
  EXPECT_EQ(targets[0].ssrc, 77U) << "before its first packet";
  PushFrame(0, 1);  // the packet has another SSRC, as a repair packet would
  EXPECT_EQ(Stats(element).Of("streams", 0)["ssrc"], 77U);
}

TEST_F(ScreamTx, APadWithoutANameGetsTheOneBehindAllBefore) {
  for (const char* name : {"sink_5", "sink_%u", "sink_2", "sink_%u"})
    EXPECT_TRUE(gst::PadPtr(gst_element_request_pad_simple(element, name))) << name;
  for (const char* name : {"sink_2", "sink_5", "sink_6", "sink_7"})
    EXPECT_TRUE(gst::PadPtr(gst_element_get_static_pad(element, name))) << name;
}

TEST_F(ScreamTx, APadWithStrictPriorityGoesBeforeWhatWaits) {
  g_object_set(element, "start-bitrate", 1'000'000U, nullptr);
  Start();
  Harness audio(gst_harness_new_with_element(element, "sink_1", nullptr));
  gst_harness_set_src_caps_str(audio.get(), kVideoCaps);
  const gst::PadPtr pad(gst_element_get_static_pad(element, "sink_1"));
  g_object_set(pad.get(), "strict-priority", TRUE, "max-bitrate", 100'000U, nullptr);
  PushFrame(0, 60);  // 60 packets take half a second at the first target
  Collect();
  const std::size_t before = sent.size();
  ASSERT_LT(before, 60U);
  Rtp r;
  r.ssrc = 0x5678;
  r.marker = true;
  ASSERT_EQ(gst_harness_push(audio.get(), NewRtp(r)), GST_FLOW_OK);
  for (int i = 0; i < 20 && sent.size() == before; ++i) {
    time.Advance(5 * GST_MSECOND);
    Acknowledge();
  }
  ASSERT_GT(sent.size(), before);
  EXPECT_EQ(sent[before].ssrc, 0x5678U);
}

TEST_F(ScreamTx, AStrictPadGetsItsMaximumBeforeOthersGetMoreThanTheyNeed) {
  g_object_set(element, "start-bitrate", 500'000, "min-bitrate", 10'000, "max-total-bitrate",
               1'000'000, nullptr);
  Start();
  Harness audio(gst_harness_new_with_element(element, "sink_1", nullptr));
  gst_harness_set_src_caps_str(audio.get(), kVideoCaps);
  const gst::PadPtr pad(gst_element_get_static_pad(element, "sink_1"));
  g_object_set(pad.get(), "strict-priority", TRUE, "max-bitrate", 800'000U, nullptr);
  for (guint16 i = 0; i < 20; ++i) {
    PushFrame(i * 900U, 1);
    Rtp r;
    r.ssrc = 0x5678;
    r.seq = i;
    r.marker = true;
    ASSERT_EQ(gst_harness_push(audio.get(), NewRtp(r)), GST_FLOW_OK);
    time.Advance(20 * GST_MSECOND);
    Acknowledge();
  }
  EXPECT_NEAR(NextTarget(audio.get()).bitrate, 800'000 * 1188.0 / 1228, 20'000);
}

TEST_F(ScreamTx, BitratesOfAPadWinOverThoseOfTheElement) {
  for (const guint min : {2'000'000U, 9'000'000U}) {  // the second minimum is above the maximum
    const gst::PadPtr pad(gst_element_request_pad_simple(element, "sink_0"));
    g_object_set(pad.get(), "min-bitrate", min, "start-bitrate", 3'000'000U, "max-bitrate",
                 5'000'000U, nullptr);
    Start();
    const auto targets = Targets(rtp.get());
    ASSERT_GE(targets.size(), 1U);
    const double share = 1188.0 / 1228;
    const guint needed = std::min(min, 5'000'000U);
    EXPECT_NEAR(targets[0].min_bitrate, needed * share, 1000);
    EXPECT_NEAR(targets[0].max_bitrate, 5'000'000 * share, 1000);
    EXPECT_NEAR(targets[0].bitrate, std::max(needed, 3'000'000U) * share, 1000);
    const GstLidarBitrateBounds unlimited{3'000'000, 0, 0};
    gst_harness_push_event(rtp.get(), gst_lidar_event_new_bitrate_bounds(&unlimited));
    EXPECT_NEAR(NextTarget(rtp.get()).max_bitrate, 5'000'000 * share, 1000);
    rtcp.reset();
    rtp.reset();
  }
}

TEST_F(ScreamTx, SeveralStreamsHaveOneStartOneSegmentAndTheEventsOfTheFirst) {
  Start();
  Harness second = AddVideoFrom(element, 5 * GST_SECOND);
  gst_harness_push_event(second.get(), gst_event_new_tag(gst_tag_list_new_empty()));
  Rtp r;
  r.ssrc = 0x5678;
  r.marker = true;
  GstBuffer* in = NewRtp(r);
  GST_BUFFER_PTS(in) = 5'500 * GST_MSECOND;
  GST_BUFFER_DTS(in) = 5'400 * GST_MSECOND;
  ASSERT_EQ(gst_harness_push(second.get(), in), GST_FLOW_OK);
  const BufferPtr out(gst_harness_pull(rtp.get()));
  ASSERT_TRUE(out);
  EXPECT_EQ(GST_BUFFER_PTS(out.get()), 500 * GST_MSECOND);
  EXPECT_EQ(GST_BUFFER_DTS(out.get()), 400 * GST_MSECOND);
  time.Advance(GST_SECOND);
  ASSERT_EQ(gst_harness_push(second.get(), NewRtp(r)), GST_FLOW_OK);
  const BufferPtr untimed(gst_harness_pull(rtp.get()));
  ASSERT_TRUE(untimed);
  EXPECT_FALSE(GST_BUFFER_PTS_IS_VALID(untimed.get()));
  EXPECT_FALSE(GST_BUFFER_DTS_IS_VALID(untimed.get()));
  std::multiset<GstEventType> events;
  while (EventPtr event{gst_harness_try_pull_event(rtp.get())})
    events.insert(GST_EVENT_TYPE(event.get()));
  EXPECT_EQ(events.count(GST_EVENT_STREAM_START), 1U);
  EXPECT_EQ(events.count(GST_EVENT_SEGMENT), 1U);
  EXPECT_EQ(events.count(GST_EVENT_TAG), 0U);
}

TEST_F(ScreamTx, OneOfSeveralStreamsMayBeginAfterTheEndOfAll) {
  Start();
  Harness second(gst_harness_new_with_element(element, "sink_1", nullptr));
  gst_harness_set_src_caps_str(second.get(), kVideoCaps);
  PushFrame(0, 1);
  gst_harness_push_event(second.get(), gst_event_new_eos());
  for (const std::size_t ends : {1U, 2U}) {
    gst_harness_push_event(rtp.get(), gst_event_new_eos());
    for (int i = 0; i < 10; ++i) {
      time.Advance(10 * GST_MSECOND);
      Acknowledge();
    }
    std::multiset<GstEventType> events;
    while (EventPtr event{gst_harness_try_pull_event(rtp.get())})
      events.insert(GST_EVENT_TYPE(event.get()));
    EXPECT_EQ(events.count(GST_EVENT_EOS), 1U);
    EXPECT_EQ(events.count(GST_EVENT_SEGMENT), 1U) << "of the stream that began";
    EXPECT_EQ(sent.size(), ends);
    ASSERT_TRUE(gst_harness_push_event(rtp.get(), gst_event_new_stream_start("next")));
    ASSERT_TRUE(gst_harness_push_event(rtp.get(), NewSegment()));
    PushFrame(1, 1);
  }
}

TEST_F(ScreamTx, AFlushOfOneOfSeveralStreamsIsItsOwn) {
  Start();
  Harness second(gst_harness_new_with_element(element, "sink_1", nullptr));
  gst_harness_set_src_caps_str(second.get(), kVideoCaps);
  gst_harness_push_event(second.get(), gst_event_new_flush_start());
  gst_harness_push_event(second.get(), gst_event_new_flush_stop(TRUE));
  PushFrame(0, 1);
  EXPECT_TRUE(BufferPtr(gst_harness_pull(rtp.get())));
  while (EventPtr event{gst_harness_try_pull_event(rtp.get())})
    EXPECT_NE(GST_EVENT_TYPE(event.get()), GST_EVENT_FLUSH_START);
}

TEST_F(ScreamTx, AFlushEndsWhereItBeganThoughAPadIsAddedMeanwhile) {
  Start();
  gst_harness_push_event(rtp.get(), gst_event_new_flush_start());
  const gst::PadPtr added(gst_element_request_pad_simple(element, "sink_%u"));
  gst_harness_push_event(rtp.get(), gst_event_new_flush_stop(TRUE));
  gst_harness_push_event(rtp.get(), NewSegment());
  PushFrame(0, 1);
  EXPECT_TRUE(BufferPtr(gst_harness_pull(rtp.get())));
}

TEST_F(ScreamTx, AFlushEndsWhereItBeganThoughTheOtherPadLeavesMeanwhile) {
  Start();
  const gst::PadPtr other(gst_element_request_pad_simple(element, "sink_%u"));
  gst_harness_push_event(rtp.get(), gst_event_new_flush_start());
  gst_element_release_request_pad(element, other.get());
  gst_harness_push_event(rtp.get(), gst_event_new_flush_stop(TRUE));
  gst_harness_push_event(rtp.get(), NewSegment());
  PushFrame(0, 1);
  EXPECT_TRUE(BufferPtr(gst_harness_pull(rtp.get())));
  while (EventPtr event{gst_harness_try_pull_event(rtp.get())})
    EXPECT_NE(GST_EVENT_TYPE(event.get()), GST_EVENT_FLUSH_STOP);
}

TEST_F(ScreamTx, AFlushEndsWithThePadThatBeganIt) {
  Start();
  gst_harness_push_event(rtp.get(), gst_event_new_flush_start());
  Harness second(gst_harness_new_with_element(element, "sink_1", nullptr));
  const gst::PadPtr first(gst_element_get_static_pad(element, "sink_0"));
  gst_element_release_request_pad(element, first.get());
  gst_harness_set_src_caps_str(second.get(), kVideoCaps);
  ASSERT_EQ(gst_harness_push(second.get(), NewRtp({})), GST_FLOW_OK);
  EXPECT_TRUE(BufferPtr(gst_harness_pull(rtp.get())));
}

TEST_F(ScreamTx, GoesOnBehindAFlushOfOneOfSeveralStreamsWhereTheNextElementHadStopped) {
  Start();
  Harness second(gst_harness_new_with_element(element, "sink_1", nullptr));
  gst_harness_set_src_caps_str(second.get(), kVideoCaps);
  PushFrame(0, 1);
  time.Advance(20 * GST_MSECOND);
  Acknowledge();
  gst_pad_set_active(rtp->sinkpad, FALSE);
  ASSERT_TRUE(Eventually([&] { return Push({}) == GST_FLOW_FLUSHING; }));
  gst_pad_set_active(rtp->sinkpad, TRUE);
  gst_test_clock_set_time(time.clock(), time.now() + GST_SECOND);
  Flush(second.get());
  ASSERT_EQ(gst_harness_push(second.get(), NewRtp({})), GST_FLOW_OK);
  EXPECT_TRUE(BufferPtr(gst_harness_pull(rtp.get())));
}

TEST_F(ScreamTx, APacketThatWaitsKeepsTheTimeOfItsSegment) {
  // More than the window allows, so some packets wait in the queue.
  constexpr guint16 kPackets = 30;
  g_object_set(element, "max-queue-delay", 10 * GST_SECOND, nullptr);
  Start();
  Harness second(gst_harness_new_with_element(element, "sink_1", nullptr));
  gst_harness_set_src_caps_str(second.get(), kVideoCaps);
  std::multiset<GstClockTime> times;
  gst_pad_add_probe(
      rtp->sinkpad, GST_PAD_PROBE_TYPE_BUFFER,
      [](GstPad*, GstPadProbeInfo* info, gpointer all) -> GstPadProbeReturn {
        static_cast<std::multiset<GstClockTime>*>(all)->insert(
            GST_BUFFER_PTS(GST_PAD_PROBE_INFO_BUFFER(info)));
        return GST_PAD_PROBE_OK;
      },
      &times, nullptr);
  const auto push = [&](guint16 seq, GstClockTime pts) {
    GstBuffer* buffer = NewRtp({seq, seq, true, 0x5678});
    GST_BUFFER_PTS(buffer) = pts;
    ASSERT_EQ(gst_harness_push(second.get(), buffer), GST_FLOW_OK);
  };
  for (guint16 seq = 0; seq < kPackets; ++seq) push(seq, 500 * GST_MSECOND);
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  segment.start = segment.time = segment.position = 5 * GST_SECOND;
  segment.base = GST_SECOND;
  ASSERT_TRUE(gst_harness_push_event(second.get(), gst_event_new_segment(&segment)));
  push(kPackets, 5'500 * GST_MSECOND);
  for (int i = 0; i < 400 && sent.size() <= kPackets; ++i) {
    time.Advance(10 * GST_MSECOND);
    Acknowledge();
  }
  EXPECT_EQ(times.count(500 * GST_MSECOND), kPackets);
  EXPECT_EQ(times.count(1'500 * GST_MSECOND), 1U);
}

TEST_F(ScreamTx, KeepsNoCapsThatWereReplaced) {
  Start();
  const gst::CapsPtr caps(gst_caps_from_string(kVideoCaps));
  const EventPtr old(gst_event_new_caps(caps.get()));
  ASSERT_TRUE(gst_harness_push_event(rtp.get(), gst_event_ref(old.get())));
  gst_harness_set_src_caps_str(rtp.get(), kRtpCaps);
  PushFrame(0, 1);
  ASSERT_TRUE(Leaves());
  while (EventPtr{gst_harness_try_pull_event(rtp.get())}) continue;
  EXPECT_TRUE(Eventually([&] { return GST_MINI_OBJECT_REFCOUNT_VALUE(old.get()) == 1; }));
}

TEST_F(ScreamTx, AStreamOfANewPadMayBeginAndEndAfterTheEndOfAll) {
  for (const bool first_leaves : {false, true}) {
    Start();
    gst_harness_push_event(rtp.get(), gst_event_new_eos());
    EXPECT_TRUE(Ends());
    const gst::PadPtr first(gst_element_get_static_pad(element, "sink_0"));
    if (first_leaves) gst_element_release_request_pad(element, first.get());
    Harness second(gst_harness_new_with_element(element, "sink_1", nullptr));
    gst_harness_set_src_caps_str(second.get(), kVideoCaps);
    ASSERT_EQ(gst_harness_push(second.get(), NewRtp({})), GST_FLOW_OK);
    EXPECT_TRUE(Leaves()) << first_leaves;
    gst_harness_push_event(second.get(), gst_event_new_eos());
    EXPECT_TRUE(Ends()) << first_leaves;
    rtcp.reset();
    rtp.reset();
    second.reset();
    gst_object_unref(element);
    element = gst_element_factory_make("screamtx", nullptr);
  }
}

TEST_F(ScreamTx, OneOfSeveralStreamsMayBeginAnewByAFlushAfterTheEndOfAll) {
  Start();
  Harness second(gst_harness_new_with_element(element, "sink_1", nullptr));
  gst_harness_set_src_caps_str(second.get(), kVideoCaps);
  for (GstHarness* h : {rtp.get(), second.get()}) gst_harness_push_event(h, gst_event_new_eos());
  EXPECT_TRUE(Ends());
  Flush(rtp.get());
  PushFrame(0, 1);
  EXPECT_TRUE(Leaves());
  gst_harness_push_event(rtp.get(), gst_event_new_eos());
  EXPECT_TRUE(Ends());
}

TEST_F(ScreamTx, ASegmentFollowsAFlushThoughAPadIsAddedMeanwhile) {
  Start();
  PushFrame(0, 1);
  EXPECT_TRUE(Leaves());
  gst_harness_push_event(rtp.get(), gst_event_new_flush_start());
  gst_harness_push_event(rtp.get(), gst_event_new_flush_stop(TRUE));
  const gst::PadPtr added(gst_element_request_pad_simple(element, "sink_%u"));
  gst_harness_push_event(rtp.get(), NewSegment());
  time.Advance(5 * GST_SECOND);
  PushFrame(0, 1);
  EXPECT_TRUE(Leaves());
  const EventPtr segment(gst_pad_get_sticky_event(rtp->sinkpad, GST_EVENT_SEGMENT, 0));
  EXPECT_TRUE(segment);
}

TEST_F(ScreamTx, AStreamKeepsItsTimesWhenTheOtherPadLeaves) {
  Start();
  Harness second = AddVideoFrom(element, 5 * GST_SECOND);
  for (guint16 seq = 0; seq < 2; ++seq) {
    GstBuffer* in = NewRtp({seq, seq, true});
    GST_BUFFER_PTS(in) = 5'500 * GST_MSECOND;
    ASSERT_EQ(gst_harness_push(second.get(), in), GST_FLOW_OK);
    const BufferPtr out(gst_harness_pull(rtp.get()));
    ASSERT_TRUE(out);
    EXPECT_EQ(GST_BUFFER_PTS(out.get()), 500 * GST_MSECOND) << "in the segment of src";
    const gst::PadPtr first(gst_element_get_static_pad(element, "sink_0"));
    if (first) gst_element_release_request_pad(element, first.get());
    time.Advance(5 * GST_SECOND);
  }
}

TEST_F(ScreamTx, SeveralStreamsMayHaveAnyCapsTogether) {
  Start();
  Harness second(gst_harness_new_with_element(element, "sink_1", nullptr));
  gst_harness_set_src_caps_str(second.get(), kVideoCaps);
  const gst::CapsPtr caps(gst_pad_peer_query_caps(rtp->sinkpad, nullptr));
  const gst::CapsPtr any(gst_caps_new_empty_simple("application/x-rtp"));
  EXPECT_TRUE(gst_caps_is_equal(caps.get(), any.get()));
}

TEST_F(ScreamTx, TargetsOfAllPadsTogetherStayBelowTheTotal) {
  g_object_set(element, "max-total-bitrate", 3'000'000U, "start-bitrate", 2'000'000U, "min-bitrate",
               10'000U, nullptr);
  Start();
  Harness second(gst_harness_new_with_element(element, "sink_1", nullptr));
  gst_harness_set_src_caps_str(second.get(), kVideoCaps);
  guint64 highest = 0;
  for (int i = 0; i < 100; ++i) {
    PushFrame(static_cast<guint32>(i) * 900, 4);
    PushSmallFrame(second.get(), i);
    for (int k = 0; k < 2; ++k) {
      time.Advance(5 * GST_MSECOND);
      Acknowledge();
    }
    highest = std::max(highest, Stats(element)["target-bitrate"]);
  }
  EXPECT_LE(highest, 3'000'000U);
  EXPECT_GE(highest, 2'900'000U);
}

}  // namespace
}  // namespace lidar::test
