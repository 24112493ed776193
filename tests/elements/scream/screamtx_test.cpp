// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of screamtx under a test clock: the events that it sends upstream, its packets, and its
// statistics.
#include <gtest/gtest.h>

#include <atomic>
#include <functional>

#include "src/rtcp/sender_report.h"
#include "tests/elements/scream/screamtx_fixture.h"
#include "tests/support/element_bus.h"
#include "tests/support/patience.h"

namespace lidar::test {
namespace {

TEST_F(ScreamTx, TellsTheEncoderItsStartBitrateWithTheCaps) {
  g_object_set(element, "start-bitrate", 2'000'000, nullptr);
  Start();
  const auto targets = Targets(rtp.get());
  ASSERT_GE(targets.size(), 1U);
  EXPECT_STREQ(targets[0].reason, "start");
  // The target counts only payload: 1188 of the 1228 bytes of a packet.
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

TEST_F(ScreamTx, LeavesTimestampsFlagsAndTheSegmentAlone) {
  Start();
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  segment.start = segment.time = 5 * GST_SECOND;
  ASSERT_TRUE(gst_harness_push_event(rtp.get(), gst_event_new_segment(&segment)));
  GstBuffer* in = NewRtp({});
  GST_BUFFER_PTS(in) = 7 * GST_SECOND;
  GST_BUFFER_DTS(in) = 6 * GST_SECOND;
  GST_BUFFER_DURATION(in) = 20 * GST_MSECOND;
  GST_BUFFER_FLAG_SET(in, GST_BUFFER_FLAG_DISCONT | GST_BUFFER_FLAG_MARKER);
  ASSERT_EQ(gst_harness_push(rtp.get(), in), GST_FLOW_OK);
  const BufferPtr out(gst_harness_pull(rtp.get()));
  EXPECT_EQ(GST_BUFFER_PTS(out.get()), 7 * GST_SECOND);
  EXPECT_EQ(GST_BUFFER_DTS(out.get()), 6 * GST_SECOND);
  EXPECT_EQ(GST_BUFFER_DURATION(out.get()), 20 * GST_MSECOND);
  EXPECT_TRUE(GST_BUFFER_FLAG_IS_SET(out.get(), GST_BUFFER_FLAG_DISCONT));
  EXPECT_TRUE(GST_BUFFER_FLAG_IS_SET(out.get(), GST_BUFFER_FLAG_MARKER));
  const EventPtr last(gst_pad_get_sticky_event(rtp->sinkpad, GST_EVENT_SEGMENT, 0));
  ASSERT_TRUE(last);
  const GstSegment* passed = nullptr;
  gst_event_parse_segment(last.get(), &passed);
  EXPECT_TRUE(gst_segment_is_equal(passed, &segment));
}

TEST_F(ScreamTx, CountsBytesAsTheyAreOnTheWire) {
  g_object_set(element, "packet-overhead", 100U, nullptr);
  Start();
  PushFrame(0, 1);
  Collect();
  EXPECT_EQ(Stats(element)["bytes-sent"], 1200U + 100);
}

TEST_F(ScreamTx, CountsWhatIsNoRtp) {
  Start();
  ASSERT_EQ(gst_harness_push(rtp.get(), FromBytes({1, 2, 3})), GST_FLOW_OK);
  ASSERT_EQ(gst_harness_push(rtp.get(), FromBytes(std::vector<std::uint8_t>(100, 0))), GST_FLOW_OK);
  PushFrame(0, 1);
  const BufferPtr out(gst_harness_pull(rtp.get()));
  EXPECT_EQ(ReadRtp(out.get()).ssrc, 0x1234U);
  EXPECT_EQ(Stats(element).Of("streams", 0)["malformed"], 2U);
  EXPECT_EQ(Stats(element).Of("streams", 0)["packets-queued"], 1U);
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
  EXPECT_GE(Stats(element)["pace-bitrate"], 3'000'000U);
}

TEST_F(ScreamTx, ConvertsTheBoundsOfTheEncoderAnewWhereItsPacketsBecomeSmall) {
  Start();
  const GstLidarBitrateBounds bounds{300'000, 800'000, 500'000};
  ASSERT_TRUE(gst_harness_push_event(rtp.get(), gst_lidar_event_new_bitrate_bounds(&bounds)));
  const auto most = [&] { return Stats(element).Of("streams", 0)["max-bitrate"]; };
  PushFrame(0, 1);
  time.Advance(10 * GST_MSECOND);
  EXPECT_LT(most(), 900'000U);
  Rtp small;
  small.size = 20;
  small.marker = true;
  for (small.seq = 1; small.seq < 600; ++small.seq) {
    small.timestamp += 90;
    ASSERT_EQ(Push(small), GST_FLOW_OK);
  }
  time.Advance(10 * GST_MSECOND);
  EXPECT_GT(most(), 2'000'000U) << "two of three bytes are headers";
}

TEST_F(ScreamTx, StartsAfreshAfterEveryStateCycle) {
  g_object_set(element, "max-queue-delay", guint64{100 * GST_MSECOND}, nullptr);
  Start();
  PushFrame(0, 30);
  PushFrame(900, 30);
  time.Advance(600 * GST_MSECOND);  // now both frames are late
  PushFrame(1800, 30);
  ASSERT_EQ(gst_harness_push(rtp.get(), FromBytes({1, 2, 3})), GST_FLOW_OK);
  const std::vector<std::uint8_t> malformed{0x8b, 205, 0, 1, 0, 0, 0, 1};
  ASSERT_EQ(gst_harness_push(rtcp.get(), FromBytes(malformed)), GST_FLOW_OK);
  rtcp::CongestionFeedback report;
  // Neither of the two reported packets was ever sent.
  report.blocks.push_back({0x1234, 30000, {{true, Ecn::kCe, Duration{0}}}});
  report.blocks.push_back({0x9999, 0, {{true, Ecn::kCe, Duration{0}}}});
  for (const bool ours : {true, false}) {
    Feed(report);
    if (ours) report.blocks.erase(report.blocks.begin());
  }
  constexpr const char* kOfRun[] = {
      "packets-sent",     "bytes-sent",     "packets-dropped",
      "frames-dropped",   "queued-bytes",   "bytes-in-flight",
      "feedback-ignored", "rtcp-malformed", "feedback-foreign-blocks"};
  constexpr const char* kOfStream[] = {"packets-queued", "packets-sent", "bytes-sent",
                                       "queued-bytes",   "malformed",    "packets-dropped",
                                       "frames-dropped", "ssrc"};
  for (const char* field : kOfRun) EXPECT_GT(Stats(element)[field], 0U) << field;
  for (const char* field : kOfStream)
    EXPECT_GT(Stats(element).Of("streams", 0)[field], 0U) << field;
  gst_element_set_state(element, GST_STATE_NULL);
  gst_element_set_state(element, GST_STATE_PLAYING);
  for (const char* field : kOfRun) EXPECT_EQ(Stats(element)[field], 0U) << field;
  for (const char* field : kOfStream)
    EXPECT_EQ(Stats(element).Of("streams", 0)[field], 0U) << field;
}

TEST_F(ScreamTx, NotifiesTheEstimatedBitrateOnTheWire) {
  g_object_set(element, "start-bitrate", 3'000'000, nullptr);
  Start();
  PushFrame(0, 1);
  time.Advance(10 * GST_MSECOND);
  guint bps = 0;
  g_object_get(element, "estimated-bitrate", &bps, nullptr);
  EXPECT_EQ(bps, 3'000'000U);
  gst_element_set_state(element, GST_STATE_NULL);
  g_object_get(element, "estimated-bitrate", &bps, nullptr);
  EXPECT_EQ(bps, 3'000'000U);
  gst_element_set_state(element, GST_STATE_PAUSED);
  g_object_get(element, "estimated-bitrate", &bps, nullptr);
  EXPECT_EQ(bps, 3'000'000U) << "until there is another";
}

/// A fixture that sends and acknowledges packets. The packets are 100 ms apart unless set
/// otherwise.
class ScreamTxReports : public ScreamTx {
 protected:
  void Run(int packets, GstClockTime apart = 100 * GST_MSECOND) {
    for (int i = 0; i < packets; ++i) {
      PushFrame(static_cast<guint32>(i) * 9000, 1);
      Acknowledge();
      time.Advance(apart);
    }
    Collect();
  }
  std::vector<rtcp::SenderReport> Reports() {
    std::vector<rtcp::SenderReport> reports;
    for (const auto& bytes : byes)
      if (const auto r = rtcp::ParseSenderReport({bytes.data(), bytes.size()}))
        reports.push_back(*r);
    return reports;
  }
};

TEST_F(ScreamTxReports, TellTheReceiverHowItSeesThePath) {
  g_object_set(element, "sender-report-interval", guint64{GST_SECOND}, nullptr);
  Start();
  Run(45);
  const auto reports = Reports();
  ASSERT_EQ(reports.size(), 4U);
  for (std::size_t i = 1; i < reports.size(); ++i)
    EXPECT_NEAR(reports[i].time_ms - reports[i - 1].time_ms, 1000, 120);
  const rtcp::SenderReport& last = reports.back();
  EXPECT_EQ(last.ssrc, 0x1234U);
  EXPECT_EQ(last.target_bitrate,
            DataRate::BitsPerSecond(static_cast<double>(Stats(element)["target-bitrate"])));
  EXPECT_GT(last.packets_sent, 39U);
  EXPECT_EQ(last.packets_lost, 0U);
  EXPECT_GT(last.ref_wnd, DataSize());
}

TEST_F(ScreamTxReports, BeginAfterTheirIntervalInEachRun) {
  g_object_set(element, "sender-report-interval", guint64{GST_SECOND}, nullptr);
  Start();
  for (int run = 0; run < 2; ++run) {
    byes.clear();
    Run(8);
    EXPECT_TRUE(Reports().empty()) << run;
    Run(5);
    EXPECT_EQ(Reports().size(), 1U) << run;
    Restart();
  }
}

TEST_F(ScreamTxReports, AreNotSentUnlessAskedForNorMoreOftenThanTenASecond) {
  Start();
  Run(15);
  EXPECT_TRUE(Reports().empty());
  g_object_set(element, "sender-report-interval", guint64{1}, nullptr);
  Run(100, 20 * GST_MSECOND);
  EXPECT_GE(Reports().size(), 15U);
  EXPECT_LE(Reports().size(), 20U);
}

/// A fixture whose encoder refuses key requests. The encoder accepts targets only if the parameter
/// is true.
class ScreamTxUnheeded : public ScreamTx, public ::testing::WithParamInterface<bool> {
 protected:
  void StartRefusing() {
    takes_targets_ = GetParam();
    Start(kVideoCaps);
    gst_pad_set_event_function(rtp->srcpad, [](GstPad*, GstObject*, GstEvent* event) -> gboolean {
      const EventPtr owner(event);
      if (gst_event_has_name(event, "GstForceKeyUnit")) ++requests_;
      return takes_targets_ && gst_event_has_name(event, "target-bitrate") ? TRUE : FALSE;
    });
  }
  bool DropsUntil(const std::function<bool()>& enough) {
    return Eventually([&] {
      PushFrame(next_seq_, 30);
      time.Advance(100 * GST_MSECOND);
      return enough();
    });
  }
  static inline std::atomic<bool> takes_targets_{false};
  static inline std::atomic<int> requests_{0};
};

TEST_P(ScreamTxUnheeded, WarnsOnceOfDroppedFramesWhereNoEncoderTakesTheTarget) {
  g_object_set(element, "max-queue-delay", guint64{50 * GST_MSECOND}, nullptr);
  const ElementBus bus(element);
  StartRefusing();
  EXPECT_TRUE(DropsUntil([this] { return Stats(element)["frames-dropped"] >= 20; }));
  requests_ = 0;
  // The warning is posted before the next request is sent, so after further requests it must be on
  // the bus.
  EXPECT_TRUE(DropsUntil([] { return requests_ >= 4; }));
  int warnings = 0;
  for (const std::string& text : bus.Texts(GST_MESSAGE_WARNING))
    warnings += text.find("no encoder upstream follows") != std::string::npos ? 1 : 0;
  EXPECT_EQ(warnings, takes_targets_ ? 0 : 1);
  gst_element_set_state(element, GST_STATE_NULL);
}
INSTANTIATE_TEST_SUITE_P(TakesTargets, ScreamTxUnheeded, ::testing::Bool());

TEST_F(ScreamTx, PostsItsStatisticsOnceWhereTheIntervalIsTheLongestUntilItIsShortened) {
  g_object_set(element, "stats-interval", guint64{G_MAXINT64}, nullptr);
  const ElementBus bus(element);
  Start();
  for (int i = 0; i < 5; ++i) {
    PushFrame(static_cast<guint32>(i), 1);
    time.Advance(100 * GST_MSECOND);
    Collect();
  }
  ASSERT_TRUE(bus.Wait(GST_MESSAGE_ELEMENT)) << "that of the start";
  g_usleep(20'000);
  EXPECT_FALSE(bus.Pop(GST_MESSAGE_ELEMENT));
  g_object_set(element, "stats-interval", guint64{GST_MSECOND}, nullptr);
  time.Settle();
  time.Advance(300 * GST_MSECOND);
  EXPECT_TRUE(bus.Wait(GST_MESSAGE_ELEMENT));
  gst_element_set_state(element, GST_STATE_NULL);
}

TEST_F(ScreamTx, PostsItsStatisticsAtTheInterval) {
  g_object_set(element, "stats-interval", guint64{100 * GST_MSECOND}, nullptr);
  const ElementBus bus(element);
  Start();
  PushFrame(0, 1);
  for (int i = 0; i < 5; ++i) {
    time.Advance(100 * GST_MSECOND);
    const gst::MessagePtr message = bus.Wait(GST_MESSAGE_ELEMENT);
    ASSERT_TRUE(message);
    EXPECT_TRUE(gst_message_has_name(message.get(), "application/x-screamtx-stats"));
  }
  g_usleep(20'000);
  int more = 0;
  while (bus.Pop(GST_MESSAGE_ELEMENT)) ++more;
  EXPECT_LE(more, 1);  // the message of the start may be one more
  gst_element_set_state(element, GST_STATE_NULL);
}

TEST_F(ScreamTx, PostsItsStatisticsAtTheIntervalWhileNothingIsSent) {
  g_object_set(element, "stats-interval", guint64{100 * GST_MSECOND}, nullptr);
  const ElementBus bus(element);
  Start();
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(bus.Wait(GST_MESSAGE_ELEMENT)) << i;  // the first message is posted at the start
    time.Advance(100 * GST_MSECOND);
  }
  gst_element_set_state(element, GST_STATE_NULL);
}

}  // namespace
}  // namespace lidar::test
