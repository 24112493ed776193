// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of the queue of screamtx under a test clock: which packets wait, which are dropped, and
// what happens at EOS.
#include <gtest/gtest.h>

#include <future>
#include <map>

#include "tests/elements/scream/screamtx_fixture.h"
#include "tests/support/patience.h"

namespace lidar::test {
namespace {

TEST_F(ScreamTx, SendsNoMoreThanTheWindowWithoutFeedback) {
  Start();
  PushFrame(0, 100);
  time.Advance(100 * GST_MSECOND);
  Collect();
  EXPECT_GE(sent.size(), 1U);
  EXPECT_LE(sent.size(), 20U);
  EXPECT_EQ(Stats(element)["packets-sent"], sent.size());
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
  EXPECT_EQ(packets[0], 30);  // the first packet of this frame had already been sent
  EXPECT_EQ(packets[99999], 2);
  EXPECT_EQ(packets.size(), 2U);
  const gst::PadPtr another(gst_element_request_pad_simple(element, "sink_%u"));
  const Stats stats(element);
  EXPECT_EQ(stats["frames-dropped"], 4U);
  EXPECT_EQ(stats["packets-dropped"], 120U);
}

TEST_F(ScreamTx, AReleasedPadLeavesItsDropsInTheCounts) {
  g_object_set(element, "max-queue-delay", guint64{100 * GST_MSECOND}, nullptr);
  Start();
  const gst::PadPtr pad(gst_element_request_pad_simple(element, "sink_%u"));
  Harness other(gst_harness_new_with_element(element, GST_PAD_NAME(pad.get()), nullptr));
  gst_harness_set_src_caps_str(other.get(), kRtpCaps);
  const auto push = [&](guint32 frame) {
    Rtp r;
    r.ssrc = 0x5678;
    r.timestamp = frame;
    for (int i = 0; i < 30; ++i, ++r.seq)
      ASSERT_EQ(gst_harness_push(other.get(), NewRtp(r)), GST_FLOW_OK);
  };
  push(0);
  push(1);
  time.Advance(210 * GST_MSECOND);
  push(2);
  const Stats before(element);
  EXPECT_EQ(before["frames-dropped"], 1U);
  EXPECT_EQ(before["packets-dropped"], 30U);
  other.reset();  // releases its pad
  const Stats after(element);
  EXPECT_EQ(after["frames-dropped"], 1U);
  EXPECT_EQ(after["packets-dropped"] + after["packets-sent"], 90U);
}

TEST_F(ScreamTx, GivesUpTheRestOfAFrameThatStuckOnItsWay) {
  g_object_set(element, "max-queue-delay", guint64{100 * GST_MSECOND}, nullptr);
  Start();
  PushFrame(0, 100);
  time.Advance(490 * GST_MSECOND);
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
  EXPECT_EQ(Push({}), GST_FLOW_EOS);
  ASSERT_GE(byes.size(), 2U);  // at least two, because one may be lost
  EXPECT_EQ(gst::ParseBye({byes[0].data(), byes[0].size()}), std::vector<guint32>{0x1234});
}

TEST_F(ScreamTx, EosDoesNotWaitForAPathThatIsGone) {
  g_object_set(element, "max-queue-delay", guint64{150 * GST_MSECOND}, nullptr);
  Start();
  PushFrame(0, 200);
  gst_harness_push_event(rtp.get(), gst_event_new_eos());
  time.Advance(290 * GST_MSECOND);
  EXPECT_FALSE(HasEos());
  time.Advance(20 * GST_MSECOND);
  EXPECT_TRUE(HasEos());
  Collect();
  EXPECT_LT(sent.size(), 200U);
  EXPECT_EQ(Stats(element)["queued-bytes"], 0U);
  EXPECT_EQ(sent.size() + Stats(element)["packets-dropped"], 200U);
  EXPECT_TRUE(byes.empty());
}

TEST_F(ScreamTx, EosOfInputThatIsNotLiveWaitsForASlowReceiver) {
  g_object_set(element, "max-queue-delay", guint64{100 * GST_MSECOND}, nullptr);
  Start();
  static const GstPadQueryFunction before = GST_PAD_QUERYFUNC(rtp->srcpad);
  const auto not_live = [](GstPad* pad, GstObject* parent, GstQuery* query) {
    const gboolean answered = before(pad, parent, query);
    if (GST_QUERY_TYPE(query) == GST_QUERY_LATENCY)
      gst_query_set_latency(query, FALSE, 0, GST_CLOCK_TIME_NONE);
    return answered;
  };
  gst_pad_set_query_function(rtp->srcpad, not_live);
  PushFrame(0, 5000);
  gst_harness_push_event(rtp.get(), gst_event_new_eos());
  bool ended = false;
  for (int i = 0; i < 100 && !ended; ++i) {
    time.Advance(150 * GST_MSECOND);
    Acknowledge();
    ended = HasEos();
  }
  EXPECT_TRUE(ended);
  Collect();
  EXPECT_EQ(sent.size(), 5000U);
}

TEST_F(ScreamTx, AFlushForgetsTheQueueAndItGoesOn) {
  Start();
  PushFrame(0, 100);
  gst_harness_push_event(rtp.get(), gst_event_new_flush_start());
  EXPECT_EQ(Push({}), GST_FLOW_FLUSHING);
  gst_harness_push_event(rtp.get(), gst_event_new_flush_stop(TRUE));
  Collect();
  sent.clear();
  gst_harness_push_event(rtp.get(), NewSegment());
  EXPECT_EQ(Stats(element)["queued-bytes"], 0U);
  acknowledged_ = 0;
  time.Advance(5 * GST_SECOND);
  PushFrame(77, 1);
  const BufferPtr out(gst_harness_pull(rtp.get()));
  ASSERT_TRUE(out);
  EXPECT_EQ(ReadRtp(out.get()).timestamp, 77U);
}

TEST_F(ScreamTx, AFlushDropsNoCapsThatWaitBehindPackets) {
  Start();
  PushFrame(0, 100);
  gst_harness_set_src_caps_str(rtp.get(), kVideoCaps);
  Flush(rtp.get());
  Collect();
  time.Advance(5 * GST_SECOND);
  PushFrame(77, 1);
  ASSERT_TRUE(BufferPtr(gst_harness_pull(rtp.get())));
  const gst::CapsPtr caps(gst_pad_get_current_caps(rtp->sinkpad));
  const gst::CapsPtr video(gst_caps_from_string(kVideoCaps));
  EXPECT_TRUE(caps && gst_caps_is_equal(caps.get(), video.get()));
}

TEST_F(ScreamTx, AFlushAfterTheEndLetsAnotherStreamBeginAndEnd) {
  StreamTwice([&] {
    gst_harness_push_event(rtp.get(), gst_event_new_flush_start());
    gst_harness_push_event(rtp.get(), gst_event_new_flush_stop(TRUE));
  });
}

TEST_F(ScreamTx, AStreamThatBeginsAfterTheEndPassesAndEnds) {
  StreamTwice(
      [&] { ASSERT_TRUE(gst_harness_push_event(rtp.get(), gst_event_new_stream_start("next"))); });
}

TEST_F(ScreamTx, AStreamOfTheNextRunPassesAndEnds) {
  StreamTwice([&] {
    gst_element_set_state(element, GST_STATE_READY);
    gst_element_set_state(element, GST_STATE_PLAYING);
    for (GstHarness* h : {rtp.get(), rtcp.get()}) {
      gst_harness_play(h);
      gst_harness_push_event(h, gst_event_new_stream_start("again"));
    }
    gst_harness_set_src_caps_str(rtp.get(), kRtpCaps);
    gst_harness_set_src_caps_str(rtcp.get(), "application/x-rtcp");
  });
}

TEST_F(ScreamTx, AnswersNoQueryThatWouldOvertakeThePackets) {
  Start();
  const gst::QueryPtr drain(gst_query_new_drain());
  EXPECT_FALSE(gst_pad_peer_query(rtp->srcpad, drain.get()));
}

/// A fixture whose upstream pad answers latency queries. The stream is live or not, as `live_`
/// says.
class ScreamTxOf : public ScreamTx {
 protected:
  void StartLive(bool live) {
    live_ = live;
    Start();
    gst_pad_set_query_function(rtp->srcpad, [](GstPad*, GstObject*, GstQuery* query) -> gboolean {
      if (GST_QUERY_TYPE(query) != GST_QUERY_LATENCY) return FALSE;
      gst_query_set_latency(query, live_ ? TRUE : FALSE, 0, GST_CLOCK_TIME_NONE);
      return TRUE;
    });
  }
  std::future<GstFlowReturn> PushAt(guint16 seq, GstClockTime pts) {
    return std::async(std::launch::async, [this, seq, pts] {
      GstBuffer* buffer = NewRtp({seq});
      GST_BUFFER_PTS(buffer) = pts;
      return gst_harness_push(rtp.get(), buffer);
    });
  }
  static bool IsIn(const std::future<GstFlowReturn>& pushed, std::chrono::milliseconds patience) {
    return pushed.wait_for(patience) == std::future_status::ready;
  }
  /// Pushes a packet, and advances the clock to the time at which the packet enters the queue.
  /// Returns this time, or GST_CLOCK_TIME_NONE if the packet enters at once.
  GstClockTime EntryOf(guint16 seq, GstClockTime pts) {
    auto pushed = PushAt(seq, pts);
    GstTestClock* clock = gst_harness_get_testclock(rtp.get());
    EXPECT_TRUE(Eventually([&] {
      return gst_test_clock_peek_id_count(clock) > 0 || IsIn(pushed, std::chrono::seconds(0));
    }));
    const GstClockTime entry = gst_test_clock_get_next_entry_time(clock);
    gst_object_unref(clock);
    if (GST_CLOCK_TIME_IS_VALID(entry)) gst_harness_crank_single_clock_wait(rtp.get());
    EXPECT_EQ(pushed.get(), GST_FLOW_OK);
    return entry;
  }
  static inline bool live_ = true;
};

TEST_F(ScreamTxOf, ALiveStreamThatFollowsOneThatIsNotEntersAtOnce) {
  StartLive(false);
  ASSERT_EQ(Push({}), GST_FLOW_OK);  // has no timestamp
  live_ = true;
  ASSERT_TRUE(gst_harness_push_event(rtp.get(), gst_event_new_stream_start("live")));
  auto pushed = PushAt(1, 3600 * GST_SECOND);
  EXPECT_TRUE(IsIn(pushed, kPatience));
  if (!IsIn(pushed, std::chrono::seconds(0))) gst_harness_crank_single_clock_wait(rtp.get());
  EXPECT_EQ(pushed.get(), GST_FLOW_OK);
}

TEST_F(ScreamTxOf, AFileEntersAtItsTimeOnTheClock) {
  StartLive(false);
  gst_element_set_base_time(element, 5 * GST_SECOND);
  EXPECT_EQ(EntryOf(0, GST_SECOND), 6 * GST_SECOND);
}

TEST_F(ScreamTxOf, AFileKeepsItsTimeBehindAFlushThroughAPauseButNotThroughAPreroll) {
  StartLive(false);
  EXPECT_EQ(EntryOf(0, 10 * GST_SECOND), 10 * GST_SECOND);
  gst_harness_push_event(rtp.get(), gst_event_new_flush_start());
  gst_harness_push_event(rtp.get(), gst_event_new_flush_stop(TRUE));
  ASSERT_TRUE(gst_harness_push_event(rtp.get(), NewSegment()));
  EXPECT_EQ(EntryOf(1, 0), 10 * GST_SECOND);
  EXPECT_EQ(EntryOf(2, GST_SECOND), 11 * GST_SECOND);
  gst_element_set_state(element, GST_STATE_PAUSED);
  gst_harness_set_time(rtp.get(), 16 * GST_SECOND);
  gst_element_set_base_time(element, 5 * GST_SECOND);
  gst_element_set_state(element, GST_STATE_PLAYING);
  EXPECT_EQ(EntryOf(3, 2 * GST_SECOND), 17 * GST_SECOND);
  // As if the preroll of another element took 12 s.
  gst_element_set_base_time(element, 17 * GST_SECOND);
  EXPECT_EQ(EntryOf(4, 3 * GST_SECOND), 20 * GST_SECOND);
}

TEST_F(ScreamTxOf, AFlushThatKeepsTheTimeShiftsNothing) {
  StartLive(false);
  EXPECT_EQ(EntryOf(0, 10 * GST_SECOND), 10 * GST_SECOND);
  gst_harness_push_event(rtp.get(), gst_event_new_flush_start());
  gst_harness_push_event(rtp.get(), gst_event_new_flush_stop(FALSE));
  ASSERT_TRUE(gst_harness_push_event(rtp.get(), NewSegment()));
  for (const guint16 seq : std::initializer_list<guint16>{5, 6, 11})
    EXPECT_EQ(EntryOf(seq, seq * GST_SECOND), seq * GST_SECOND);
}

TEST_F(ScreamTxOf, AFileWaitsForRoomAndLosesNothing) {
  g_object_set(element, "max-queue-delay", guint64{100 * GST_MSECOND}, nullptr);
  StartLive(false);
  PushFrame(0, 30);
  PushFrame(900, 30);
  time.Advance(150 * GST_MSECOND);
  auto pushed = PushAt(60, GST_CLOCK_TIME_NONE);
  EXPECT_FALSE(IsIn(pushed, std::chrono::milliseconds(50)));
  while (!IsIn(pushed, std::chrono::milliseconds(0))) {
    time.Advance(10 * GST_MSECOND);
    Acknowledge();
  }
  EXPECT_EQ(pushed.get(), GST_FLOW_OK);
  EXPECT_EQ(Stats(element)["packets-dropped"], 0U);
}

TEST_F(ScreamTxOf, AFileWaitsBehindItsFirstPacketWhileItIsPaused) {
  StartLive(false);
  PushFrame(0, 30);
  PushFrame(900, 30);
  gst_element_set_state(element, GST_STATE_PAUSED);
  auto pushed = PushAt(60, GST_CLOCK_TIME_NONE);
  EXPECT_FALSE(IsIn(pushed, std::chrono::milliseconds(50)));
  gst_element_set_state(element, GST_STATE_PLAYING);
  EXPECT_TRUE(IsIn(pushed, kPatience));
  EXPECT_EQ(pushed.get(), GST_FLOW_OK);
}

/// The sink of a paused pipeline needs a packet to preroll. Therefore a waiting packet must enter
/// when the element pauses.
TEST_F(ScreamTxOf, APacketThatWaitsForItsTimeEntersAtAPause) {
  StartLive(false);
  auto pushed = PushAt(0, 3600 * GST_SECOND);
  EXPECT_TRUE(gst_harness_wait_for_clock_id_waits(rtp.get(), 1, kPatience.count()));
  gst_element_set_state(element, GST_STATE_PAUSED);
  EXPECT_TRUE(IsIn(pushed, kPatience));
  if (!IsIn(pushed, std::chrono::seconds(0))) gst_harness_crank_single_clock_wait(rtp.get());
  EXPECT_EQ(pushed.get(), GST_FLOW_OK);
}

TEST_F(ScreamTxOf, AFileHasNoLatency) {
  StartLive(false);
  const gst::QueryPtr query(gst_query_new_latency());
  ASSERT_TRUE(gst_pad_peer_query(rtp->sinkpad, query.get()));
  GstClockTime min = 7;
  gst_query_parse_latency(query.get(), nullptr, &min, nullptr);
  EXPECT_EQ(min, 0U);
}

TEST_F(ScreamTx, AsksAVideoEncoderForKeyFramesTwiceASecondAtMost) {
  g_object_set(element, "max-queue-delay", guint64{50 * GST_MSECOND}, nullptr);
  Start(kVideoCaps);
  for (guint32 i = 0; i < 20; ++i) {
    PushFrame(i * 900, 30);
    time.Advance(100 * GST_MSECOND);
    g_usleep(1'000);
  }
  const auto asked = NamesUpstream(rtp.get()).count("GstForceKeyUnit");
  EXPECT_GE(asked, 1U);
  EXPECT_LE(asked, 6U);
}

TEST_F(ScreamTx, AsksAVideoEncoderForOneKeyFrameAfterEachLossWhereAskedTo) {
  guint32 frame = 0;
  const auto run = [&](int frames) {
    for (int i = 0; i < frames; ++i) {
      PushFrame(frame++ * 1'800, 1);
      time.Advance(20 * GST_MSECOND);
      Acknowledge();
    }
  };
  Start(kVideoCaps);
  for (const bool asks : {false, true, true}) {
    g_object_set(element, "key-unit-on-loss", static_cast<gboolean>(asks), nullptr);
    run(50);
    EXPECT_EQ(NamesUpstream(rtp.get()).count("GstForceKeyUnit"), 0U);
    const guint64 lost = Stats(element)["packets-lost"];
    PushFrame(frame++ * 1'800, 1);
    time.Advance(20 * GST_MSECOND);
    Collect();
    ASSERT_EQ(sent.size(), acknowledged_ + 1);
    rtcp::CongestionFeedback report;
    report.sender_ssrc = receiver;
    report.blocks.push_back({sent.back().ssrc, sent.back().seq, {{false, Ecn::kNotEct, {}}}});
    for (int i = 0; i < 10; ++i) {
      PushFrame(frame++ * 1'800, 1);
      time.Advance(20 * GST_MSECOND);
    }
    Collect();
    ASSERT_GT(sent.size(), acknowledged_ + 3);
    while (report.blocks[0].metrics.size() < sent.size() - acknowledged_)
      report.blocks[0].metrics.push_back({true, Ecn::kEct1, Duration{0}});
    acknowledged_ = sent.size();
    report.report_timestamp = static_cast<std::uint32_t>(
        gst_util_uint64_scale(time.now(), 65536, GST_SECOND) & 0xffffffff);
    Feed(report);
    run(50);
    EXPECT_EQ(Stats(element)["packets-lost"], lost + 1);
    EXPECT_EQ(NamesUpstream(rtp.get()).count("GstForceKeyUnit"), asks ? 1U : 0U);
  }
}

TEST_F(ScreamTx, AsksNoOtherEncoderForKeyFrames) {
  g_object_set(element, "max-queue-delay", guint64{100 * GST_MSECOND}, nullptr);
  Start();
  PushFrame(0, 30);
  PushFrame(900, 30);
  time.Advance(300 * GST_MSECOND);
  EXPECT_EQ(Stats(element)["frames-dropped"], 1U);
  EXPECT_EQ(NamesUpstream(rtp.get()).count("GstForceKeyUnit"), 0U);
}

TEST_F(ScreamTx, AsksForNoKeyFrameOnceTheStreamIsNoVideoAnyMore) {
  g_object_set(element, "max-queue-delay", guint64{100 * GST_MSECOND}, nullptr);
  Start(kVideoCaps);
  gst_harness_set_src_caps_str(rtp.get(), kRtpCaps);
  PushFrame(0, 30);
  PushFrame(900, 30);
  time.Advance(600 * GST_MSECOND);
  EXPECT_GE(Stats(element)["frames-dropped"], 1U);
  EXPECT_EQ(NamesUpstream(rtp.get()).count("GstForceKeyUnit"), 0U);
}

TEST_F(ScreamTx, AddsItsLongestDelayToTheLatency) {
  g_object_set(element, "max-queue-delay", guint64{70 * GST_MSECOND}, nullptr);
  Start();
  gst_harness_set_upstream_latency(rtp.get(), 30 * GST_MSECOND);
  EXPECT_EQ(gst_harness_query_latency(rtp.get()), 100 * GST_MSECOND);
  // Takes effect at the next start.
  g_object_set(element, "max-queue-delay", 10 * GST_SECOND, nullptr);
  EXPECT_EQ(gst_harness_query_latency(rtp.get()), 100 * GST_MSECOND);
}

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
          acknowledged_ = sent.size();  // these packets are lost
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
  // The queue gets 4 packets every 20 ms, and frames are dropped after they have waited for 200 ms.
  // But if the first packets of a frame have been sent, its other packets may wait for 1 s. Later
  // frames wait behind them.
  EXPECT_LE(down["queued-bytes"], 51U * 4 * 1228);
  EXPECT_GT(down["packets-sent"], 0U);
  run(GST_SECOND, true);
  EXPECT_GT(Stats(element)["target-bitrate"], before / 2);
}

}  // namespace
}  // namespace lidar::test
