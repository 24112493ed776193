// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/elements/rtplidar/slices.h"
#include "tests/support/element_bus.h"

namespace lidar::test {
namespace {

TEST(RtpLidarDepay, TellsSlicesThatWereNeverSentFromLostOnes) {
  for (const bool aggregate : {false, true}) {
    Harness pay(gst_harness_new("rtplidarpay"));
    g_object_set(pay->element, "aggregate", aggregate, nullptr);
    gst_harness_set_src_caps_str(pay.get(), EncodedCaps().c_str());
    // The encoder skips slice 1 of each scan, and all of scan 3.
    for (guint s = 0; s < 6; ++s)
      for (guint i = 0; i < kSlices; ++i)
        if (s != 3 && i != 1) gst_harness_push(pay.get(), EncodedSlice(s, i, 200));
    const auto packets = Pull(pay.get());
    const Harness h = Depay();
    for (std::size_t n = 0; n < packets.size(); ++n)
      if (n != 5) gst_harness_push(h.get(), gst_buffer_copy_deep(packets[n].get()));
    gst_harness_push_event(h.get(), gst_event_new_eos());
    const auto slices = Pull(h.get());
    // Packet 0 is the config. Packet 5, which is lost, is slice 2 of scan 1. With aggregates, it is
    // the whole last scan instead.
    EXPECT_EQ(Stat(h.get(), "slices-received"), slices.size());
    EXPECT_EQ(Stat(h.get(), "slices-lost"), aggregate ? 0U : 1U);
    EXPECT_EQ(Stat(h.get(), "slices-skipped"), aggregate ? 4U : 5U);
    EXPECT_EQ(Stat(h.get(), "scans-complete"), 4U);
    EXPECT_EQ(Stat(h.get(), "scans-incomplete"), aggregate ? 0U : 1U);
    EXPECT_EQ(Stat(h.get(), "scans-skipped"), 1U);
  }
}

TEST(RtpLidarDepay, RestoresSlicesMetasTimesAndCaps) {
  for (const bool aggregate : {false, true}) {
    const gsize size = aggregate ? 300 : 3'000;
    const Harness h = Depay();
    Push(h.get(), Packets(3, size, aggregate));
    const auto slices = Pull(h.get());
    ASSERT_EQ(slices.size(), 12U);
    for (guint n = 0; n < slices.size(); ++n) {
      const gst::BufferPtr sent(EncodedSlice(n / 4, n % 4, size));
      GstLidarSlice meta{};
      ASSERT_TRUE(gst_lidar_buffer_get_slice(slices[n].get(), &meta));
      EXPECT_EQ(meta.scan_id, n / 4);
      EXPECT_EQ(meta.slice_index, n % 4);
      EXPECT_EQ(meta.slice_count, kSlices);
      EXPECT_EQ(meta.first_column, n % 4 * 128);
      EXPECT_EQ(gst_lidar_buffer_get_capture_time(slices[n].get()),
                gst_lidar_buffer_get_capture_time(sent.get()));
      EXPECT_EQ(GST_BUFFER_PTS(slices[n].get()), GST_BUFFER_PTS(sent.get()));
      EXPECT_EQ(GST_BUFFER_DURATION(slices[n].get()), 25 * GST_MSECOND);
      const gst::BufferMap a(slices[n].get(), GST_MAP_READ);
      const gst::BufferMap b(sent.get(), GST_MAP_READ);
      EXPECT_TRUE(std::equal(a.view().begin(), a.view().end(), b.view().begin(), b.view().end()));
      EXPECT_EQ(GST_BUFFER_FLAG_IS_SET(slices[n].get(), GST_BUFFER_FLAG_DISCONT), n == 0);
      EXPECT_EQ(GST_BUFFER_FLAG_IS_SET(slices[n].get(), GST_BUFFER_FLAG_MARKER), n % 4 == 3);
    }
    const gst::CapsPtr caps(gst_pad_get_current_caps(h->sinkpad));
    const gst::CapsPtr expected(gst_caps_from_string(EncodedCaps().c_str()));
    EXPECT_TRUE(gst_caps_is_equal(caps.get(), expected.get()));
    EXPECT_EQ(Stat(h.get(), "scans-complete"), 3U);
  }
}

/// The parameter names the time that the slice lacks: 1 the PTS, 2 the duration, 3 the capture
/// time. With 0, the slice has all of them.
class SliceWithout : public ::testing::TestWithParam<int> {};
TEST_P(SliceWithout, ATimeComesOutWithoutItAndWithTheOthers) {
  for (const bool aggregate : {false, true}) {
    Harness pay(gst_harness_new("rtplidarpay"));
    g_object_set(pay->element, "aggregate", aggregate, nullptr);
    gst_harness_set_src_caps_str(pay.get(), EncodedCaps().c_str());
    GstBuffer* sent = gst_buffer_new_allocate(nullptr, 100, nullptr);
    const GstLidarSlice meta{3, kSlices - 1, kSlices, 0};
    gst_lidar_buffer_set_slice(sent, &meta);
    const GstClockTime pts = GetParam() == 1 ? GST_CLOCK_TIME_NONE : GST_SECOND;
    const GstClockTime duration = GetParam() == 2 ? GST_CLOCK_TIME_NONE : 25 * GST_MSECOND;
    const GstClockTime capture = GetParam() == 3 ? GST_CLOCK_TIME_NONE : kCaptureStart;
    GST_BUFFER_PTS(sent) = pts;
    GST_BUFFER_DURATION(sent) = duration;
    if (GetParam() != 3) gst_lidar_buffer_set_capture_time(sent, kCaptureStart);
    ASSERT_EQ(gst_harness_push(pay.get(), sent), GST_FLOW_OK);
    gst_harness_push_event(pay.get(), gst_event_new_eos());
    const Harness h = Depay();
    while (GstBuffer* b = gst_harness_try_pull(pay.get())) gst_harness_push(h.get(), b);
    const auto slices = Pull(h.get());
    ASSERT_EQ(slices.size(), 1U);
    EXPECT_EQ(GST_BUFFER_PTS(slices[0].get()), pts);
    EXPECT_EQ(GST_BUFFER_DURATION(slices[0].get()), duration);
    EXPECT_EQ(gst_lidar_buffer_get_capture_time(slices[0].get()), capture);
  }
}
INSTANTIATE_TEST_SUITE_P(PtsDurationOrCapture, SliceWithout, ::testing::Range(0, 4));

TEST(RtpLidarDepay, LosesOnlyTheSliceOfALostPacketAndCountsIt) {
  auto packets = Packets(5);
  packets.erase(packets.begin() + 9);
  const Harness h = Depay();
  Push(h.get(), packets);
  const auto slices = Pull(h.get());
  EXPECT_EQ(slices.size(), 19U);
  EXPECT_EQ(Stat(h.get(), "slices-lost"), 1U);
  EXPECT_EQ(Stat(h.get(), "scans-complete"), 4U);
  EXPECT_EQ(Stat(h.get(), "scans-incomplete"), 1U);
}

TEST(RtpLidarDepay, TakesBufferListsAndReorderedPackets) {
  auto packets = Packets(4);
  for (std::size_t i = 4; i + 7 < packets.size(); i += 8)
    std::reverse(packets.begin() + static_cast<std::ptrdiff_t>(i),
                 packets.begin() + static_cast<std::ptrdiff_t>(i + 7));
  GstBufferList* list = gst_buffer_list_new();
  for (const auto& p : packets) gst_buffer_list_add(list, gst_buffer_copy_deep(p.get()));
  const Harness h = Depay();
  ASSERT_EQ(gst_pad_push_list(h->srcpad, list), GST_FLOW_OK);
  EXPECT_EQ(Pull(h.get()).size(), 16U);
}

TEST(RtpLidarDepay, DropsWhatIsNotItsPayloadTypeOrNotRtpWithoutAMessage) {
  const Harness h = Depay();
  const ElementBus bus(h->element);
  for (const auto& p : Packets(1)) {
    GstBuffer* foreign = gst_buffer_copy_deep(p.get());
    GstRTPBuffer rtp = GST_RTP_BUFFER_INIT;
    gst_rtp_buffer_map(foreign, GST_MAP_WRITE, &rtp);
    gst_rtp_buffer_set_payload_type(&rtp, 97);
    gst_rtp_buffer_unmap(&rtp);
    ASSERT_EQ(gst_harness_push(h.get(), foreign), GST_FLOW_OK);
    const guint8 garbage[] = {1, 2, 3, 4, 5};
    ASSERT_EQ(gst_harness_push(h.get(), gst_buffer_new_memdup(garbage, 5)), GST_FLOW_OK);
    ASSERT_EQ(gst_harness_push(h.get(), gst_buffer_new()), GST_FLOW_OK);
  }
  EXPECT_EQ(Pull(h.get()).size(), 0U);
  EXPECT_EQ(Stat(h.get(), "packets-wrong-payload-type"), 13U);
  EXPECT_EQ(Stat(h.get(), "packets-invalid"), 26U);
  EXPECT_FALSE(bus.Pop(GST_MESSAGE_WARNING | GST_MESSAGE_ERROR));
  Push(h.get(), Packets(1));
  EXPECT_EQ(Pull(h.get()).size(), 4U);
}

TEST(RtpLidarDepay, WarnsOnceWhereOnlyAnotherPayloadTypeComes) {
  const Harness h(gst_harness_new("rtplidardepay"));
  gst_harness_set_src_caps_str(
      h.get(),
      "application/x-rtp,media=application,clock-rate=90000,encoding-name=X-LIDAR-DRACO,"
      "payload=97");
  const ElementBus bus(h->element);
  Push(h.get(), Packets(6));
  const auto texts = bus.Texts(GST_MESSAGE_WARNING);
  ASSERT_EQ(texts.size(), 1U);
  EXPECT_NE(texts[0].find("payload type 96, not 97"), std::string::npos) << texts[0];
}

TEST(RtpLidarDepay, WarnsOnceOfASecondStreamThatIsDropped) {
  const Harness h = Depay();
  const ElementBus bus(h->element);
  const auto first = Packets(20);
  const auto second = Packets(20);  // a second stream with another SSRC at the same time
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i)
    for (const auto* packets : {&first, &second})
      gst_harness_push(h.get(), gst_buffer_copy_deep((*packets)[i].get()));
  EXPECT_EQ(Pull(h.get()).size(), 80U);
  const auto texts = bus.Texts(GST_MESSAGE_WARNING);
  ASSERT_EQ(texts.size(), 1U);
  EXPECT_NE(texts[0].find("Two streams"), std::string::npos) << texts[0];
}

TEST(RtpLidarDepay, FollowsASenderThatRestarts) {
  const Harness h = Depay();
  Push(h.get(), Packets(3));
  auto again = Packets(3);  // sent later, with another SSRC and other sequence numbers
  for (auto& p : again) {
    p.reset(gst_buffer_make_writable(p.release()));
    GST_BUFFER_PTS(p.get()) += 5 * GST_SECOND;
  }
  Push(h.get(), again);
  EXPECT_EQ(Pull(h.get()).size(), 24U);
  EXPECT_EQ(Stat(h.get(), "sender-restarts"), 1U);
  EXPECT_EQ(Stat(h.get(), "slices-lost"), 0U);
}

TEST(RtpLidarDepay, FollowsNewCapsInMidStream) {
  Harness pay(gst_harness_new("rtplidarpay"));
  const Harness h = Depay();
  guint scan = 0;
  for (const int rate : {10, 20, 10}) {
    gst_harness_set_src_caps_str(pay.get(), EncodedCaps("range", rate).c_str());
    for (guint i = 0; i < kSlices; ++i) gst_harness_push(pay.get(), EncodedSlice(scan, i));
    ++scan;
    while (GstBuffer* b = gst_harness_try_pull(pay.get())) gst_harness_push(h.get(), b);
    EXPECT_EQ(Pull(h.get()).size(), kSlices);
    const gst::CapsPtr caps(gst_pad_get_current_caps(h->sinkpad));
    gint n = 0;
    gint d = 0;
    gst_structure_get_fraction(gst_caps_get_structure(caps.get(), 0), "framerate", &n, &d);
    EXPECT_EQ(n, rate);
  }
}

TEST(RtpLidarDepay, WaitsForPacketsAsLongAsIsSetWhileItRuns) {
  for (const guint64 wait : {100U, 1000U}) {
    const Harness h = Depay();
    auto packets = Packets(8);
    // Slice 1 of scan 1 arrives half a second late.
    std::rotate(packets.begin() + 16, packets.begin() + 19, packets.end());
    for (std::size_t i = 0; i < packets.size(); ++i) {
      if (i == 2) g_object_set(h->element, "max-reorder-time", wait * GST_MSECOND, nullptr);
      gst_harness_push(h.get(), gst_buffer_copy_deep(packets[i].get()));
    }
    EXPECT_EQ(Pull(h.get()).size(), wait == 100 ? 31U : 32U);
  }
}

TEST(RtpLidarDepay, TellsWhichCoderMadeTheSlices) {
  Harness pay(gst_harness_new("rtplidarpay"));
  const Harness h = Depay();
  guint scan = 0;
  for (const char* type :
       {GST_LIDAR_SLICE_MEDIA_TYPE, GST_LIDAR_DRACO_MEDIA_TYPE, GST_LIDAR_SLICE_MEDIA_TYPE}) {
    gst_harness_set_src_caps_str(pay.get(), EncodedCaps("range", 10, type).c_str());
    for (guint i = 0; i < kSlices; ++i) gst_harness_push(pay.get(), EncodedSlice(scan, i));
    ++scan;
    while (GstBuffer* b = gst_harness_try_pull(pay.get())) gst_harness_push(h.get(), b);
    EXPECT_EQ(Pull(h.get()).size(), kSlices);
    const gst::CapsPtr caps(gst_pad_get_current_caps(h->sinkpad));
    EXPECT_STREQ(gst_structure_get_name(gst_caps_get_structure(caps.get(), 0)), type);
  }
}

TEST(RtpLidarDepay, CountsWhatTheEndCutsOffAndRunsAgain) {
  const Harness h = Depay();
  for (int i = 0; i < 3; ++i) {
    auto packets = Packets(1);
    packets.pop_back();
    Push(h.get(), packets);
    EXPECT_EQ(Pull(h.get()).size(), 3U);
    EXPECT_EQ(Stat(h.get(), "slices-lost"), 0U);
    gst_harness_push_event(h.get(), gst_event_new_eos());
    EXPECT_EQ(Stat(h.get(), "slices-lost"), 1U);
    EXPECT_EQ(Stat(h.get(), "scans-incomplete"), 1U);
    gst_element_set_state(h->element, GST_STATE_NULL);
    gst_element_set_state(h->element, GST_STATE_PLAYING);
    gst_harness_push_event(h.get(), gst_event_new_stream_start("again"));
    gst_harness_set_src_caps_str(h.get(), kRtpCaps);
  }
}

TEST(RtpLidarDepay, StartsAnewAfterAFlush) {
  const Harness h = Depay();
  auto packets = Packets(1);
  packets.pop_back();
  Push(h.get(), packets);
  EXPECT_EQ(Pull(h.get()).size(), 3U);
  Flush(h.get());
  Push(h.get(), Packets(2));
  EXPECT_EQ(Pull(h.get()).size(), 8U);
}

TEST(RtpLidarDepay, ItsTimeGoesOnWhereANewSegmentBeginsAtZero) {
  const Harness h = Depay();
  auto packets = Packets(8);
  const std::size_t half = packets.size() / 2;
  const GstClockTime start = GST_BUFFER_PTS(packets[half].get());
  for (std::size_t i = 0; i < packets.size(); ++i) {
    if (i == half) gst_harness_push_event(h.get(), NewSegment());
    if (i == half + 2) continue;
    GstBuffer* packet = gst_buffer_copy_deep(packets[i].get());
    if (i >= half) GST_BUFFER_PTS(packet) -= start;
    gst_harness_push(h.get(), packet);
  }
  EXPECT_EQ(Stat(h.get(), "slices-lost"), 1U) << "without a wait for the old times";
}

TEST(RtpLidarDepay, KeepsTheBaseClassStatistics) {
  const Harness h = Depay();
  Push(h.get(), Packets(1));
  EXPECT_EQ(Stat(h.get(), "clock_rate"), 90'000U);
}

TEST(RtpLidarDepay, WarnsOfNoOtherTypeBesideItsOwn) {
  const Harness h = Depay();
  const ElementBus bus(h->element);
  Push(h.get(), Packets(2));
  Push(h.get(), WithType(Packets(20), 111));
  EXPECT_GT(Stat(h.get(), "packets-wrong-payload-type"), 20U);
  EXPECT_FALSE(bus.Pop(GST_MESSAGE_WARNING));
}

TEST(RtpLidarDepay, WaitsForLatePacketsAsLongAsItWasSetBeforeTheStart) {
  for (const guint64 wait : {guint64{0}, guint64{GST_SECOND}}) {
    Harness h(gst_harness_new("rtplidardepay"));
    gst_element_set_state(h->element, GST_STATE_NULL);
    g_object_set(h->element, "max-reorder-time", wait, nullptr);
    gst_element_set_state(h->element, GST_STATE_PLAYING);
    gst_harness_set_src_caps_str(h.get(), kRtpCaps);
    auto packets = Packets(4);
    std::rotate(packets.begin() + 5, packets.begin() + 6, packets.end() - 4);
    Push(h.get(), packets);
    EXPECT_EQ(Stat(h.get(), "slices-lost"), wait == 0 ? 1U : 0U);
  }
}

TEST(RtpLidarDepay, GivesBackAFramerateThatIsNoWholeNumber) {
  std::string caps = EncodedCaps();
  const std::string rate = "(fraction)10/1";
  caps.replace(caps.find(rate), rate.size(), "(fraction)30000/1001");
  Harness pay(gst_harness_new("rtplidarpay"));
  gst_harness_set_src_caps_str(pay.get(), caps.c_str());
  gst_harness_push(pay.get(), EncodedSlice(0, 0));
  const Harness h = Depay();
  Push(h.get(), Pull(pay.get()));
  const gst::CapsPtr out(gst_pad_get_current_caps(h->sinkpad));
  const gst::CapsPtr expected(gst_caps_from_string(caps.c_str()));
  EXPECT_TRUE(gst_caps_is_equal(out.get(), expected.get()));
}

}  // namespace
}  // namespace lidar::test
