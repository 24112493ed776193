// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of the limits of payloader and depayloader, and of their state after a flush or a restart.
#include <gtest/gtest.h>

#include "tests/elements/rtplidar/slices.h"
#include "tests/support/element_bus.h"

namespace lidar::test {
namespace {

class PayLimits : public ::testing::Test {
 protected:
  PayLimits() { gst_harness_set_src_caps_str(h_.get(), EncodedCaps().c_str()); }
  GstFlowReturn Push(guint scan, guint index, gsize size = 100) {
    return gst_harness_push(h_.get(), EncodedSlice(scan, index, size));
  }
  GstFlowReturn PushAt(guint column, guint count) {
    GstBuffer* buffer = EncodedSlice(0, 0, 100);
    const GstLidarSlice meta{0, 0, count, column};
    gst_lidar_buffer_set_slice(buffer, &meta);
    return gst_harness_push(h_.get(), buffer);
  }
  /// Returns the number of config packets that were sent since the last call.
  std::size_t Configs() {
    std::size_t n = 0;
    for (const Rtp& p : PullAll(h_.get())) n += p.IsConfig() ? 1U : 0U;
    return n;
  }
  void Restart() {
    gst_element_set_state(h_->element, GST_STATE_NULL);
    gst_element_set_state(h_->element, GST_STATE_PLAYING);
    gst_harness_push_event(h_.get(), gst_event_new_stream_start("again"));
    gst_harness_set_src_caps_str(h_.get(), EncodedCaps().c_str());
  }

  Harness h_{gst_harness_new("rtplidarpay")};
};

TEST_F(PayLimits, TheConfigIsRepeatedOnceItsIntervalIsOver) {
  Push(0, 0);
  EXPECT_EQ(Configs(), 1U);
  Push(9, 3);  // pushed at 975 ms
  EXPECT_EQ(Configs(), 0U);
  Push(10, 0);
  EXPECT_EQ(Configs(), 1U);
}

TEST_F(PayLimits, TheConfigIsRepeatedWhereTimesSayNothingOfItsInterval) {
  const auto push = [this](GstClockTime pts) {
    GstBuffer* buffer = EncodedSlice(0, 0, 100);
    GST_BUFFER_PTS(buffer) = pts;
    EXPECT_EQ(gst_harness_push(h_.get(), buffer), GST_FLOW_OK);
    return Configs();
  };
  EXPECT_EQ(push(GST_CLOCK_TIME_NONE), 1U);
  EXPECT_EQ(push(GST_CLOCK_TIME_NONE), 1U) << "no time passes: each slice has it";
  EXPECT_EQ(push(5 * GST_SECOND), 1U) << "the one before has no time";
  EXPECT_EQ(push(5 * GST_SECOND + 1), 0U);
  EXPECT_EQ(push(5 * GST_SECOND - 1), 1U) << "time went back";
  g_object_set(h_->element, "config-interval", 0, nullptr);
  EXPECT_EQ(push(GST_CLOCK_TIME_NONE), 0U);
  EXPECT_EQ(push(GST_SECOND), 0U);
}

TEST_F(PayLimits, TheConfigComesAgainAfterAFlushAndWhereTheSsrcChanges) {
  g_object_set(h_->element, "config-interval", 0, nullptr);
  Push(0, 0);
  EXPECT_EQ(Configs(), 1U);
  Push(0, 1);
  EXPECT_EQ(Configs(), 0U);
  Flush(h_.get());
  Push(0, 2);
  EXPECT_EQ(Configs(), 1U);
  gst_harness_push_upstream_event(
      h_.get(),
      gst_event_new_custom(GST_EVENT_CUSTOM_UPSTREAM,
                           gst_structure_new("GstRTPCollision", "ssrc", G_TYPE_UINT, 1U, nullptr)));
  Push(0, 3);
  EXPECT_EQ(Configs(), 1U);
}

TEST_F(PayLimits, BoundsAreThoseOfTheirRunAlone) {
  const auto bounds_sent = [this] {
    std::size_t n = 0;
    GstLidarBitrateBounds bounds{};
    while (const gst::EventPtr event{gst_harness_try_pull_event(h_.get())})
      n += gst_lidar_event_parse_bitrate_bounds(event.get(), &bounds) != FALSE ? 1U : 0U;
    return n;
  };
  const GstLidarBitrateBounds bounds{1'000'000, 8'000'000, 2'000'000};
  gst_harness_push_event(h_.get(), gst_lidar_event_new_bitrate_bounds(&bounds));
  for (guint scan = 0; scan < 50; ++scan) Push(scan, 0, 30);
  EXPECT_GE(bounds_sent(), 2U) << "headers are more than was guessed";
  // Makes the pad forget its sticky events.
  for (const bool active : {false, true}) gst_pad_set_active(h_->srcpad, active);
  Restart();
  for (guint scan = 0; scan < 50; ++scan) Push(scan, 0, 30);
  EXPECT_EQ(bounds_sent(), 0U) << "the encoder has told none in this run";
}

TEST_F(PayLimits, AMetaMayBeAsLargeAsTheFormat) {
  EXPECT_EQ(PushAt(G_MAXUINT16, 4'096), GST_FLOW_OK);
  EXPECT_EQ(PushAt(0, 4'097), GST_FLOW_ERROR);
  Restart();
  EXPECT_EQ(PushAt(G_MAXUINT16 + 1U, 4'096), GST_FLOW_ERROR);
}

TEST_F(PayLimits, WhatWasCollectedGoesFirstWhereAggregationEnds) {
  g_object_set(h_->element, "aggregate", TRUE, "config-interval", 0, nullptr);
  Push(0, 0);
  g_object_set(h_->element, "aggregate", FALSE, nullptr);
  Push(0, 1);
  const auto packets = PullAll(h_.get());
  ASSERT_EQ(packets.size(), 3U);
  EXPECT_EQ(packets[1].payload[15], 0);  // index of the slice
  EXPECT_EQ(packets[2].payload[15], 1);
}

TEST_F(PayLimits, ScansAreCountedAndThoseWithoutAMetaNumbered) {
  for (guint i = 0; i < 8; ++i) Push(i / 4, i % 4);
  EXPECT_EQ(Stat(h_.get(), "scans-sent"), 2U);
  for (int round = 0; round < 2; ++round) {
    Restart();
    PullAll(h_.get());
    for (guint8 scan = 0; scan < 3; ++scan) {
      GstBuffer* buffer = gst_buffer_new_allocate(nullptr, 100, nullptr);
      gst_buffer_memset(buffer, 0, 0, 100);
      GST_BUFFER_PTS(buffer) = scan * GST_MSECOND;
      gst_harness_push(h_.get(), buffer);
      EXPECT_EQ(PullAll(h_.get()).back().payload[21], scan);  // id of the scan
    }
    EXPECT_EQ(Stat(h_.get(), "scans-sent"), 3U);
  }
}

TEST_F(PayLimits, EachRateOfTheTargetIsWithoutHeaders) {
  const GstLidarTargetBitrate target{5'000'000, 42, 1'000'000, 10'000'000, 7, 8, "update"};
  GstEvent* event = gst_lidar_event_new_target_bitrate(&target);
  const guint32 seqnum = gst_event_get_seqnum(event);
  gst_harness_push_upstream_event(h_.get(), event);
  while (const gst::EventPtr seen{gst_harness_try_pull_upstream_event(h_.get())}) {
    GstLidarTargetBitrate t{};
    if (!gst_lidar_event_parse_target_bitrate(seen.get(), &t)) continue;
    EXPECT_NEAR(t.max_bitrate, 2.0 * t.bitrate, 2);
    EXPECT_NEAR(t.min_bitrate, 0.2 * t.bitrate, 2);
    EXPECT_LT(t.max_bitrate, 10'000'000U);
    EXPECT_EQ(t.ssrc, 42U);
    EXPECT_EQ(t.rtt, 7U);
    EXPECT_EQ(t.queue_delay, 8U);
    EXPECT_STREQ(t.reason, "update");
    EXPECT_EQ(gst_event_get_seqnum(seen.get()), seqnum);
    return;
  }
  ADD_FAILURE() << "no target";
}

TEST_F(PayLimits, TellsTheEncoderOfEachSliceThatAReceiverHasUpToTheMostOfAnEvent) {
  constexpr guint kMany = GST_LIDAR_MAX_RECEIVED + 50;
  for (guint i = 0; i < kMany; ++i) Push(i / 4, i % 4);
  const auto packets = PullAll(h_.get());
  GstRTPBuffer rtp = GST_RTP_BUFFER_INIT;
  ASSERT_TRUE(gst_rtp_buffer_map(packets[0].buffer.get(), GST_MAP_READ, &rtp));
  GstLidarPacketsReceived received{};
  received.receiver = 77;
  received.ssrc = gst_rtp_buffer_get_ssrc(&rtp);
  gst_rtp_buffer_unmap(&rtp);
  received.count = 1;
  received.ranges[0] = {packets.front().sequence, packets.back().sequence};
  gst_harness_push_upstream_event(h_.get(), gst_lidar_event_new_packets_received(&received));
  while (const gst::EventPtr seen{gst_harness_try_pull_upstream_event(h_.get())}) {
    GstLidarSlicesReceived slices{};
    if (!gst_lidar_event_parse_slices_received(seen.get(), &slices)) continue;
    EXPECT_EQ(slices.receiver, 77U);
    EXPECT_EQ(slices.count, guint{GST_LIDAR_MAX_RECEIVED});
    return;
  }
  ADD_FAILURE() << "no receipt";
}

TEST_F(PayLimits, SaysThatAggregatesChangeTheLatency) {
  const gst::ElementPtr pay(gst_element_factory_make("rtplidarpay", nullptr));
  gst_object_ref_sink(pay.get());
  const ElementBus bus(pay.get());
  g_object_set(pay.get(), "config-interval", 3, nullptr);
  EXPECT_FALSE(bus.Pop(GST_MESSAGE_LATENCY));
  g_object_set(pay.get(), "aggregate", TRUE, nullptr);
  EXPECT_TRUE(bus.Pop(GST_MESSAGE_LATENCY));
}

TEST_F(PayLimits, SaysThatAnotherFrameRateOfAggregatesChangesTheLatency) {
  const ElementBus bus(h_->element);
  gst_harness_set_src_caps_str(h_.get(), EncodedCaps("range", 20).c_str());
  EXPECT_FALSE(bus.Pop(GST_MESSAGE_LATENCY)) << "without aggregates";
  g_object_set(h_->element, "aggregate", TRUE, nullptr);
  EXPECT_TRUE(bus.Pop(GST_MESSAGE_LATENCY));
  EXPECT_EQ(gst_harness_query_latency(h_.get()), 50 * GST_MSECOND);
  gst_harness_set_src_caps_str(h_.get(), EncodedCaps("xyz", 20).c_str());
  EXPECT_FALSE(bus.Pop(GST_MESSAGE_LATENCY)) << "the same frame rate";
  gst_harness_set_src_caps_str(h_.get(), EncodedCaps("xyz", 5).c_str());
  EXPECT_TRUE(bus.Pop(GST_MESSAGE_LATENCY));
  EXPECT_EQ(gst_harness_query_latency(h_.get()), 200 * GST_MSECOND);
}

TEST_F(PayLimits, AFlushForgetsWhatWasCollected) {
  g_object_set(h_->element, "aggregate", TRUE, "config-interval", 0, nullptr);
  Push(0, 0);
  Flush(h_.get());
  Push(0, 1);
  gst_harness_push_event(h_.get(), gst_event_new_eos());
  const auto packets = PullAll(h_.get());
  ASSERT_EQ(packets.size(), 2U);
  EXPECT_EQ(packets[1].payload[15], 1);  // index of the slice
}

/// A fixture with a depayloader. Tests may change the packets that it gets.
class DepayLimits : public ::testing::Test {
 protected:
  static std::vector<gst::BufferPtr> Packets(guint scans) {
    const Harness pay(gst_harness_new("rtplidarpay"));
    gst_harness_set_src_caps_str(pay.get(), EncodedCaps().c_str());
    for (guint i = 0; i < scans * kSlices; ++i)
      gst_harness_push(pay.get(), EncodedSlice(i / kSlices, i % kSlices, 100));
    std::vector<gst::BufferPtr> packets;
    while (GstBuffer* packet = gst_harness_try_pull(pay.get())) packets.emplace_back(packet);
    return packets;
  }
  void SetCaps(const char* more) {
    const std::string caps =
        "application/x-rtp,media=application,clock-rate=90000,encoding-name=X-LIDAR-DRACO";
    gst_harness_set_src_caps_str(h_.get(), (caps + more).c_str());
  }
  void Push(const gst::BufferPtr& packet, GstClockTime pts) {
    GstBuffer* copy = gst_buffer_copy_deep(packet.get());
    GST_BUFFER_PTS(copy) = pts;
    gst_harness_push(h_.get(), copy);
  }
  /// Returns the number of slices that the depayloader has output since the last call.
  std::size_t Slices() {
    std::size_t n = 0;
    while (const gst::BufferPtr slice{gst_harness_try_pull(h_.get())}) ++n;
    return n;
  }

  Harness h_{gst_harness_new("rtplidardepay")};
};

TEST_F(DepayLimits, APacketOfBeforeDoesNotTurnTheTimeBack) {
  SetCaps(",payload=96");
  const auto stream = Packets(3), another = Packets(3);
  for (std::size_t i = 0; i + 1 < stream.size(); ++i) Push(stream[i], 10 * GST_SECOND);
  Push(stream.back(), GST_SECOND);
  // The late packet must not make the stream seem silent. Therefore another stream would have to
  // send for longer before it replaces this stream.
  for (const auto& packet : another) Push(packet, 10 * GST_SECOND);
  EXPECT_EQ(Slices(), 12U);
  EXPECT_EQ(Stat(h_.get(), "sender-restarts"), 0U);
}

TEST_F(DepayLimits, ThePayloadTypeIsThatOfTheLatestCaps) {
  SetCaps(",payload=97");
  const auto packets = Packets(1);
  for (const auto& packet : packets) Push(packet, 0);
  EXPECT_EQ(Slices(), 0U);
  SetCaps(",payload=96");
  for (const auto& packet : packets) Push(packet, 0);
  EXPECT_EQ(Slices(), 4U);
}

TEST_F(DepayLimits, TimeMayBeginAnewAfterAFlush) {
  SetCaps(",payload=96");
  for (const auto& packet : Packets(1)) Push(packet, 1000 * GST_SECOND);
  EXPECT_EQ(Slices(), 4U);
  Flush(h_.get());
  auto packets = Packets(4);
  packets.erase(packets.begin() + 2);
  g_object_set(h_->element, "max-reorder-time", 100 * GST_MSECOND, nullptr);
  for (const auto& packet : packets) Push(packet, GST_BUFFER_PTS(packet.get()));
  EXPECT_EQ(Stat(h_.get(), "slices-lost"), 1U);
  EXPECT_EQ(Slices(), 15U);
}

TEST_F(DepayLimits, AnyNumberOfFlushesMayTurnTheTimeBack) {
  SetCaps(",payload=96");
  const auto packets = Packets(1);
  for (guint64 i = 20; i > 0; --i) {
    for (const auto& packet : packets) Push(packet, i * GST_SECOND);
    Flush(h_.get());
  }
  EXPECT_EQ(Slices(), 80U);
}

TEST_F(DepayLimits, WarnsAtTheTwentiethPacketOfAnotherTypeAndAgainAfterARestart) {
  const auto packets = Packets(8);
  const ElementBus bus(h_->element);
  SetCaps(",payload=97");
  for (int round = 0; round < 2; ++round) {
    for (std::size_t i = 0; i < 22; ++i) {
      Push(packets.at(i), 0);
      const gst::MessagePtr warning = bus.Pop(GST_MESSAGE_WARNING);
      EXPECT_EQ(warning != nullptr, i == 19) << i;
    }
    EXPECT_EQ(Stat(h_.get(), "packets-wrong-payload-type"), 22U);
    gst_element_set_state(h_->element, GST_STATE_READY);
    gst_element_set_state(h_->element, GST_STATE_PLAYING);
    EXPECT_EQ(Stat(h_.get(), "packets-wrong-payload-type"), 0U);
    gst_harness_push_event(h_.get(), gst_event_new_stream_start("again"));
    SetCaps(",payload=97");
  }
}

}  // namespace
}  // namespace lidar::test
