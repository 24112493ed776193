// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include "tests/elements/rtplidar/slices.h"
#include "tests/support/element_bus.h"

namespace lidar::test {
namespace {

Harness Pay() {
  Harness h(gst_harness_new("rtplidarpay"));
  gst_harness_set_src_caps_str(h.get(), EncodedCaps().c_str());
  return h;
}

TEST(RtpLidarPay, NegotiatesItsMediaAndClockRate) {
  const Harness h = Pay();
  ASSERT_EQ(gst_harness_push(h.get(), EncodedSlice(0, 0)), GST_FLOW_OK);
  const gst::CapsPtr caps(gst_pad_get_current_caps(h->sinkpad));
  const GstStructure* s = gst_caps_get_structure(caps.get(), 0);
  EXPECT_STREQ(gst_structure_get_string(s, "media"), "application");
  EXPECT_STREQ(gst_structure_get_string(s, "encoding-name"), "X-LIDAR-DRACO");
  gint rate = 0;
  EXPECT_TRUE(gst_structure_get_int(s, "clock-rate", &rate));
  EXPECT_EQ(rate, 90'000);
}

TEST(RtpLidarPay, TravelsAsVideoWhereNothingElseIsTaken) {
  Harness h(gst_harness_new("rtplidarpay"));
  gst_harness_set_sink_caps_str(h.get(), "application/x-rtp,media=video");
  gst_harness_set_src_caps_str(h.get(), EncodedCaps().c_str());
  ASSERT_EQ(gst_harness_push(h.get(), EncodedSlice(0, 0)), GST_FLOW_OK);
  const gst::CapsPtr caps(gst_pad_get_current_caps(h->sinkpad));
  EXPECT_STREQ(gst_structure_get_string(gst_caps_get_structure(caps.get(), 0), "media"), "video");
}

TEST(RtpLidarPay, SendsTheConfigFirstThenTheSliceWithItsMarkerLast) {
  const Harness h = Pay();
  ASSERT_EQ(gst_harness_push(h.get(), EncodedSlice(0, 0)), GST_FLOW_OK);
  const auto packets = PullAll(h.get());
  ASSERT_EQ(packets.size(), 4U);
  EXPECT_TRUE(packets[0].IsConfig());
  EXPECT_FALSE(packets[0].marker);
  EXPECT_EQ(packets[1].payload[0], 0x42);
  EXPECT_EQ(packets[2].payload[0], 0x62);
  EXPECT_FALSE(packets[2].marker);
  EXPECT_EQ(packets[3].payload[0], 0x82);
  EXPECT_TRUE(packets[3].marker);
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_EQ(packets[i].sequence, static_cast<guint16>(packets[0].sequence + i));
    EXPECT_EQ(packets[i].timestamp, packets[0].timestamp);
    GstLidarSlice slice{};
    EXPECT_TRUE(gst_lidar_buffer_get_slice(packets[i].buffer.get(), &slice));
  }
}

TEST(RtpLidarPay, TakesTheTimestampFromTheFirstColumn) {
  const Harness h = Pay();
  gst_harness_push(h.get(), EncodedSlice(0, 0));
  const guint32 first = PullAll(h.get()).back().timestamp;
  gst_harness_push(h.get(), EncodedSlice(0, 1));
  EXPECT_EQ(PullAll(h.get()).back().timestamp - first, 90'000U / 40);
}

class Mtu : public ::testing::TestWithParam<guint> {};
TEST_P(Mtu, IsKeptByEveryPacketAndFilled) {
  const Harness h = Pay();
  g_object_set(h->element, "mtu", GetParam(), nullptr);
  for (const gsize size : {gsize{1}, gsize{1'000}, gsize{1'352}, gsize{1'353}, gsize{50'000}})
    ASSERT_EQ(gst_harness_push(h.get(), EncodedSlice(0, 0, size)), GST_FLOW_OK);
  gsize largest = 0;
  for (const Rtp& p : PullAll(h.get())) {
    largest = std::max(largest, gst_buffer_get_size(p.buffer.get()));
    ASSERT_LE(gst_buffer_get_size(p.buffer.get()), GetParam());
  }
  EXPECT_EQ(largest, GetParam());
}
INSTANTIATE_TEST_SUITE_P(Mtus, Mtu, ::testing::Values(76, 100, 576, 1'200, 1'400, 9'000));

TEST(RtpLidarPay, RepeatsTheConfigAtItsIntervalAndWhenAsked) {
  const Harness h = Pay();
  const auto configs = [&](guint from, guint to) {
    for (guint scan = from; scan < to; ++scan)
      for (guint i = 0; i < kSlices; ++i) gst_harness_push(h.get(), EncodedSlice(scan, i, 100));
    int n = 0;
    for (const Rtp& p : PullAll(h.get())) n += p.IsConfig() ? 1 : 0;
    return n;
  };
  EXPECT_EQ(configs(0, 30), 3);
  EXPECT_EQ(configs(30, 31), 1);
  gst_harness_push_upstream_event(
      h.get(),
      gst_event_new_custom(GST_EVENT_CUSTOM_UPSTREAM, gst_structure_new_empty("GstForceKeyUnit")));
  EXPECT_EQ(configs(31, 32), 1);
  g_object_set(h->element, "config-interval", 0, nullptr);
  EXPECT_EQ(configs(32, 132), 0);
}

TEST(RtpLidarPay, ChangesTheConfigIdWithTheCapsAndKeepsItWithout) {
  const Harness h = Pay();
  gst_harness_push(h.get(), EncodedSlice(0, 0, 100));
  const guint8 id = PullAll(h.get()).back().payload[1];
  gst_harness_set_src_caps_str(h.get(), EncodedCaps("range", 20).c_str());
  gst_harness_push(h.get(), EncodedSlice(0, 1, 100));
  const auto packets = PullAll(h.get());
  ASSERT_EQ(packets.size(), 2U);
  EXPECT_TRUE(packets[0].IsConfig());
  EXPECT_EQ(packets[0].payload[1], packets[1].payload[1]);
  EXPECT_NE(packets[1].payload[1], id);
  gst_harness_set_src_caps_str(h.get(), EncodedCaps("range", 20).c_str());
  gst_harness_push(h.get(), EncodedSlice(0, 2, 100));
  EXPECT_EQ(PullAll(h.get()).size(), 1U);
}

TEST(RtpLidarPay, AggregatesTheSmallSlicesOfAScan) {
  const Harness h = Pay();
  g_object_set(h->element, "aggregate", TRUE, "config-interval", 0, nullptr);
  for (guint scan = 0; scan < 2; ++scan)
    for (guint i = 0; i < kSlices; ++i) gst_harness_push(h.get(), EncodedSlice(scan, i, 200));
  auto packets = PullAll(h.get());
  ASSERT_EQ(packets.size(), 3U);
  EXPECT_TRUE(packets[0].IsConfig());
  EXPECT_EQ(packets[1].payload[0], 0x20);
  EXPECT_TRUE(packets[1].marker);
  EXPECT_EQ(packets[2].payload.size(), 1 + kSlices * (4 + 36 + 200));
  // An aggregate is sent when the next slice does not fit into it, or at EOS.
  gst_harness_push(h.get(), EncodedSlice(2, 0, 200));
  gst_harness_push(h.get(), EncodedSlice(2, 1, 5'000));
  gst_harness_push(h.get(), EncodedSlice(2, 2, 200));
  gst_harness_push_event(h.get(), gst_event_new_eos());
  packets = PullAll(h.get());
  ASSERT_EQ(packets.size(), 6U);
  EXPECT_EQ(packets[0].payload[0], 0x02);
  EXPECT_EQ(packets[5].payload[0], 0x02);
}

TEST(RtpLidarPay, AggregatesNoSlicesOfTwoScans) {
  const Harness h = Pay();
  g_object_set(h->element, "aggregate", TRUE, "config-interval", 0, nullptr);
  gst_harness_push(h.get(), EncodedSlice(0, 0, 100));  // the encoder skipped the rest of this scan
  gst_harness_push(h.get(), EncodedSlice(1, 0, 100));
  gst_harness_push_event(h.get(), gst_event_new_eos());
  const auto packets = PullAll(h.get());
  ASSERT_EQ(packets.size(), 3U);
  EXPECT_EQ(packets[1].payload[0], 0x02);
  EXPECT_EQ(packets[2].payload[0], 0x03);
}

TEST(RtpLidarPay, HoldsAggregatesNoLongerThanMaxPtime) {
  const Harness h = Pay();
  g_object_set(h->element, "aggregate", TRUE, "config-interval", 0, "max-ptime",
               gint64{50 * GST_MSECOND}, nullptr);
  for (guint i = 0; i < kSlices; ++i) gst_harness_push(h.get(), EncodedSlice(0, i, 50));
  EXPECT_EQ(PullAll(h.get()).size(), 3U);
  EXPECT_EQ(gst_harness_query_latency(h.get()), 50 * GST_MSECOND);
}

/// Each slice lasts 25 ms. The duration of an aggregate is the time from the start of its first
/// slice to the end of its last slice.
TEST(RtpLidarPay, CountsTheDurationOfTheLastSliceInMaxPtime) {
  for (const gint64 max_ms : {49, 50, 51}) {
    const Harness h(gst_harness_new("rtplidarpay"));
    g_object_set(h->element, "aggregate", TRUE, "config-interval", 0, "max-ptime",
                 gint64{max_ms * GST_MSECOND}, nullptr);
    gst_harness_set_src_caps_str(h.get(), EncodedCaps().c_str());
    gst_harness_push(h.get(), EncodedSlice(0, 0, 100));
    gst_harness_push(h.get(), EncodedSlice(0, 1, 100));
    std::size_t slices = 0;
    for (const Rtp& packet : PullAll(h.get())) slices += packet.IsConfig() ? 0U : 1U;
    EXPECT_EQ(slices, max_ms <= 50 ? 1U : 0U) << max_ms;
  }
}

TEST(RtpLidarPay, SendsWhatItCollectedBeforeANewSegment) {
  const Harness h(gst_harness_new("rtplidarpay"));
  g_object_set(h->element, "aggregate", TRUE, "config-interval", 0, nullptr);
  gst_harness_set_src_caps_str(h.get(), EncodedCaps().c_str());
  for (guint i = 0; i < kSlices; ++i) gst_harness_push(h.get(), EncodedSlice(0, i, 100));
  gst_harness_push(h.get(), EncodedSlice(1, 0, 100));
  const auto before = gst_harness_buffers_received(h.get());
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  segment.base = GST_SECOND;
  const gst::PadPtr src(gst_element_get_static_pad(h->element, "src"));
  std::string order;
  gst_pad_add_probe(
      src.get(),
      static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_BUFFER_LIST |
                                   GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM),
      [](GstPad*, GstPadProbeInfo* info, gpointer data) {
        auto& text = *static_cast<std::string*>(data);
        if ((info->type & GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM) == 0)
          text += "packet ";
        else if (GST_EVENT_TYPE(info->data) == GST_EVENT_SEGMENT)
          text += "segment ";
        return GST_PAD_PROBE_OK;
      },
      &order, nullptr);
  gst_harness_push_event(h.get(), gst_event_new_segment(&segment));
  EXPECT_EQ(gst_harness_buffers_received(h.get()), before + 1);
  EXPECT_EQ(order, "packet segment ");
}

TEST(RtpLidarPay, TakesItsHeadersOffTheTargetBitrate) {
  const Harness h = Pay();
  const GstLidarTargetBitrate target{5'000'000, 42, 1'000'000, 10'000'000, 7, 8, "update"};
  gst_harness_push_upstream_event(h.get(), gst_lidar_event_new_target_bitrate(&target));
  for (guint scan = 0; scan < 50; ++scan)
    for (guint i = 0; i < kSlices; ++i) gst_harness_push(h.get(), EncodedSlice(scan, i, 3'000));
  gst_harness_push_upstream_event(h.get(), gst_lidar_event_new_target_bitrate(&target));
  std::vector<GstLidarTargetBitrate> seen;
  while (GstEvent* e = gst_harness_try_pull_upstream_event(h.get())) {
    const gst::EventPtr event(e);
    GstLidarTargetBitrate t{};
    if (gst_lidar_event_parse_target_bitrate(e, &t)) seen.push_back(t);
  }
  ASSERT_EQ(seen.size(), 2U);
  // The payloader first assumes 10 bytes of headers in each full packet.
  EXPECT_NEAR(seen[0].bitrate, 5e6 * (1 - 10.0 / 1'388), 2);
  const double share = static_cast<double>(Stat(h.get(), "slice-bytes")) /
                       static_cast<double>(Stat(h.get(), "payload-bytes"));
  EXPECT_NEAR(seen[1].bitrate, 5e6 * share, 5e6 * 0.001);
  EXPECT_NEAR(seen[1].min_bitrate, 1e6 * share, 1e6 * 0.001);
  EXPECT_EQ(seen[1].ssrc, 42U);
  EXPECT_EQ(seen[1].rtt, 7U);
}

TEST(RtpLidarPay, AddsItsHeadersToTheBoundsOfTheEncoder) {
  const Harness h = Pay();
  const GstLidarBitrateBounds needed{1'000'000, 8'000'000, 2'000'000};
  gst_harness_push_event(h.get(), gst_lidar_event_new_bitrate_bounds(&needed));
  for (guint scan = 0; scan < 50; ++scan)
    for (guint i = 0; i < kSlices; ++i) gst_harness_push(h.get(), EncodedSlice(scan, i, 400));
  std::vector<GstLidarBitrateBounds> seen;
  while (const gst::EventPtr event{gst_harness_try_pull_event(h.get())}) {
    GstLidarBitrateBounds bounds{};
    if (gst_lidar_event_parse_bitrate_bounds(event.get(), &bounds)) seen.push_back(bounds);
  }
  // The first bounds are based on an assumed share of the headers. The bounds are sent again
  // whenever the measured share has changed by more than 2 %.
  ASSERT_GE(seen.size(), 2U);
  EXPECT_LE(seen.size(), 8U);
  const double share = static_cast<double>(Stat(h.get(), "slice-bytes")) /
                       static_cast<double>(Stat(h.get(), "payload-bytes"));
  EXPECT_LT(share, 0.93);
  EXPECT_NEAR(seen.back().min_bitrate * share, 1e6, 0.03e6);
  EXPECT_NEAR(seen.back().max_bitrate * share, 8e6, 0.24e6);
  EXPECT_NEAR(seen.back().nominal_bitrate * share, 2e6, 0.06e6);
}

class CapsThatNoReceiverCouldUse : public ::testing::TestWithParam<const char*> {};
TEST_P(CapsThatNoReceiverCouldUse, AreRefusedWithOneError) {
  const Harness h(gst_harness_new("rtplidarpay"));
  const ElementBus bus(h->element);
  gst_harness_push_event(h.get(), gst_event_new_stream_start("test"));
  const gst::CapsPtr caps(gst_caps_from_string(GetParam()));
  gst_harness_push_event(h.get(), gst_event_new_caps(caps.get()));
  gst_harness_push_event(h.get(), NewSegment());
  EXPECT_EQ(gst_harness_push(h.get(), EncodedSlice(0, 0)), GST_FLOW_NOT_NEGOTIATED);
  EXPECT_TRUE(bus.Pop(GST_MESSAGE_ERROR));
  EXPECT_FALSE(bus.Pop(GST_MESSAGE_ERROR));  // there is no second error
  for (const char* next : {"application/x-voxels,alignment=slice", GetParam()})
    gst_harness_set_src_caps_str(h.get(), next);
  EXPECT_TRUE(bus.Pop(GST_MESSAGE_ERROR)) << "they come again behind others";
}
INSTANTIATE_TEST_SUITE_P(
    All, CapsThatNoReceiverCouldUse,
    ::testing::Values("application/x-draco,alignment=slice,geometry=range,"
                      "fields=(string)\"x:F32:0,y:F32:4,z:F32:8,range:U32:12\"",
                      "application/x-voxels", "application/x-voxels,alignment=scan",
                      "application/x-voxels,alignment=slice,n=(int)<1,2>",
                      "application/x-pointcloud2,alignment=slice", "video/x-raw,alignment=slice"));

TEST(RtpLidarPay, RefusesMetasOutOfRangeAndMtusWithoutRoom) {
  {
    const Harness h = Pay();
    GstBuffer* buffer = EncodedSlice(0, 0);
    const GstLidarSlice bad{0, 4, 4, 0};
    gst_lidar_buffer_set_slice(buffer, &bad);
    EXPECT_EQ(gst_harness_push(h.get(), buffer), GST_FLOW_ERROR);
  }
  const Harness h = Pay();
  g_object_set(h->element, "mtu", 75, nullptr);
  EXPECT_EQ(gst_harness_push(h.get(), EncodedSlice(0, 0)), GST_FLOW_ERROR);
}

TEST(RtpLidarPay, DropsEmptyBuffersAndCountsThem) {
  const Harness h = Pay();
  EXPECT_EQ(gst_harness_push(h.get(), EncodedSlice(0, 0, 0)), GST_FLOW_OK);
  EXPECT_EQ(PullAll(h.get()).size(), 0U);
  EXPECT_EQ(Stat(h.get(), "empty-dropped"), 1U);
}

TEST(RtpLidarPay, SendsTheConfigAgainAfterEveryRestart) {
  const Harness h = Pay();
  for (int i = 0; i < 3; ++i) {
    gst_harness_push(h.get(), EncodedSlice(0, 0, 100));
    EXPECT_EQ(PullAll(h.get()).size(), 2U);
    EXPECT_EQ(Stat(h.get(), "slices-sent"), 1U);
    gst_element_set_state(h->element, GST_STATE_NULL);
    gst_element_set_state(h->element, GST_STATE_PLAYING);
    gst_harness_set_src_caps_str(h.get(), EncodedCaps().c_str());
  }
}

TEST(RtpLidarPay, GivesEachPacketTheTimesOfItsSlice) {
  const Harness h = Pay();
  gst_harness_push(h.get(), EncodedSlice(0, 1));
  for (const Rtp& p : PullAll(h.get())) {
    EXPECT_EQ(GST_BUFFER_PTS(p.buffer.get()), 25 * GST_MSECOND);
    EXPECT_EQ(GST_BUFFER_DURATION(p.buffer.get()), 25 * GST_MSECOND);
  }
}

TEST(RtpLidarPay, RepeatsTheConfigWhereTimeGoesBack) {
  const Harness h = Pay();
  gst_harness_push(h.get(), EncodedSlice(100, 0));
  PullAll(h.get());
  gst_harness_push(h.get(), EncodedSlice(0, 0));
  EXPECT_TRUE(PullAll(h.get()).front().IsConfig());
  gst_harness_push(h.get(), EncodedSlice(0, 1));
  EXPECT_FALSE(PullAll(h.get()).front().IsConfig());
}

TEST(RtpLidarPay, SaysThatASliceIsTooLarge) {
  const Harness h = Pay();
  const ElementBus bus(h->element);
  EXPECT_EQ(gst_harness_push(h.get(), EncodedSlice(0, 0, gsize{4} << 20)), GST_FLOW_OK);
  EXPECT_EQ(gst_harness_push(h.get(), EncodedSlice(0, 1, (gsize{4} << 20) + 1)), GST_FLOW_ERROR);
  EXPECT_EQ(bus.Text(GST_MESSAGE_ERROR), "A slice of 4194305 bytes cannot be sent.");
}

TEST(RtpLidarPay, RefusesASensorModelThatIsTooLongForAConfig) {
  const Harness h(gst_harness_new("rtplidarpay"));
  const gst::CapsPtr caps(gst_caps_from_string(EncodedCaps("xyz").c_str()));
  const gst::BufferPtr model(gst_buffer_new_allocate(nullptr, 0x1'0000, nullptr));
  gst_buffer_memset(model.get(), 0, 1, 0x1'0000);
  gst_caps_set_simple(caps.get(), "sensor-model", GST_TYPE_BUFFER, model.get(), nullptr);
  gst_harness_set_src_caps(h.get(), gst_caps_ref(caps.get()));
  EXPECT_EQ(gst_harness_push(h.get(), EncodedSlice(0, 0)), GST_FLOW_NOT_NEGOTIATED);
}

TEST(RtpLidarPay, RefusesASensorModelThatIsNone) {
  Harness h(gst_harness_new("rtplidarpay"));
  gst_harness_set_src_caps_str(
      h.get(),
      "application/x-draco,geometry=xyz,alignment=slice,fields=(string)\"x:F32:0,y:F32:4,z:F32:8\","
      "framerate=10/1,sensor-model=(string)none");
  EXPECT_EQ(gst_harness_push(h.get(), EncodedSlice(0, 0)), GST_FLOW_NOT_NEGOTIATED);
}

}  // namespace
}  // namespace lidar::test
