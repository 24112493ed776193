// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of the events of gstlidar.h: their content, and which events of other programs are refused.
#include <gtest/gtest.h>

#include <utility>

#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"

namespace lidar::gst {
namespace {

TEST(Events, CarryTheTargetAndTheBounds) {
  const GstLidarTargetBitrate target{5'000'000,        42,          100'000, 20'000'000,
                                     40 * GST_MSECOND, GST_MSECOND, "update"};
  const EventPtr up(gst_lidar_event_new_target_bitrate(&target));
  GstLidarTargetBitrate read{};
  ASSERT_TRUE(gst_lidar_event_parse_target_bitrate(up.get(), &read));
  EXPECT_EQ(read.bitrate, 5'000'000U);
  EXPECT_EQ(read.ssrc, 42U);
  EXPECT_EQ(read.min_bitrate, 100'000U);
  EXPECT_EQ(read.max_bitrate, 20'000'000U);
  EXPECT_EQ(read.rtt, 40 * GST_MSECOND);
  EXPECT_EQ(read.queue_delay, GST_MSECOND);
  EXPECT_STREQ(read.reason, "update");

  const GstLidarBitrateBounds bounds{1, 2, 3};
  const EventPtr down(gst_lidar_event_new_bitrate_bounds(&bounds));
  EXPECT_TRUE(GST_EVENT_IS_STICKY(down.get()));
  GstLidarBitrateBounds got{};
  ASSERT_TRUE(gst_lidar_event_parse_bitrate_bounds(down.get(), &got));
  EXPECT_EQ(got.min_bitrate, 1U);
  EXPECT_EQ(got.max_bitrate, 2U);
  EXPECT_EQ(got.nominal_bitrate, 3U);
  EXPECT_FALSE(gst_lidar_event_parse_bitrate_bounds(up.get(), &got));
  EXPECT_FALSE(gst_lidar_event_parse_target_bitrate(down.get(), &read));
}

TEST(Events, OfForeignSendersMayHaveATargetAlone) {
  const auto upstream = [](GstStructure* s) {
    return EventPtr(gst_event_new_custom(GST_EVENT_CUSTOM_UPSTREAM, s));
  };
  GstLidarTargetBitrate read{1, 2, 3, 4, 5, 6, "before"};
  const EventPtr alone = upstream(
      gst_structure_new(GST_LIDAR_TARGET_BITRATE_EVENT, "bitrate", G_TYPE_UINT, 700U, nullptr));
  ASSERT_TRUE(gst_lidar_event_parse_target_bitrate(alone.get(), &read));
  EXPECT_EQ(read.bitrate, 700U);
  EXPECT_EQ(read.ssrc + read.min_bitrate + read.max_bitrate + read.rtt + read.queue_delay, 0U);
  EXPECT_EQ(read.reason, nullptr);
  const EventPtr none = upstream(gst_structure_new_empty(GST_LIDAR_TARGET_BITRATE_EVENT));
  EXPECT_FALSE(gst_lidar_event_parse_target_bitrate(none.get(), &read));
  const EventPtr other = upstream(gst_structure_new("other", "bitrate", G_TYPE_UINT, 1U, nullptr));
  EXPECT_FALSE(gst_lidar_event_parse_target_bitrate(other.get(), &read));
  const GstLidarTargetBitrate without_reason{};
  const EventPtr usual(gst_lidar_event_new_target_bitrate(&without_reason));
  ASSERT_TRUE(gst_lidar_event_parse_target_bitrate(usual.get(), &read));
  EXPECT_STREQ(read.reason, "update");
}

TEST(Events, CarryWhatAReceiverHas) {
  for (const guint count : {0U, 1U, 2U, guint{GST_LIDAR_MAX_RECEIVED}}) {
    GstLidarPacketsReceived packets{};
    packets.ssrc = 7;
    packets.receiver = 8;
    packets.count = count;
    GstLidarSlicesReceived slices{9, count, {}};
    for (guint i = 0; i < count; ++i) {
      packets.ranges[i] = {static_cast<guint16>(65'535 - i), static_cast<guint16>(2 * i)};
      slices.slices[i] = {4'000'000'000U + i, i};
    }
    const EventPtr of_packets(gst_lidar_event_new_packets_received(&packets));
    GstLidarPacketsReceived got_packets{};
    ASSERT_TRUE(gst_lidar_event_parse_packets_received(of_packets.get(), &got_packets));
    EXPECT_EQ(got_packets.ssrc, 7U);
    EXPECT_EQ(got_packets.receiver, 8U);
    ASSERT_EQ(got_packets.count, count);
    const EventPtr of_slices(gst_lidar_event_new_slices_received(&slices));
    GstLidarSlicesReceived got_slices{};
    ASSERT_TRUE(gst_lidar_event_parse_slices_received(of_slices.get(), &got_slices));
    EXPECT_EQ(got_slices.receiver, 9U);
    ASSERT_EQ(got_slices.count, count);
    for (guint i = 0; i < count; ++i) {
      EXPECT_EQ(got_packets.ranges[i].first, packets.ranges[i].first) << i;
      EXPECT_EQ(got_packets.ranges[i].last, packets.ranges[i].last) << i;
      EXPECT_EQ(got_slices.slices[i].scan_id, slices.slices[i].scan_id) << i;
      EXPECT_EQ(got_slices.slices[i].slice_index, slices.slices[i].slice_index) << i;
    }
    EXPECT_FALSE(gst_lidar_event_parse_packets_received(of_slices.get(), &got_packets));
    EXPECT_FALSE(gst_lidar_event_parse_slices_received(of_packets.get(), &got_slices));
  }
}

/// Returns a slices-received event. Its list has `count` numbers of the type `type`.
EventPtr SlicesEvent(guint count, GType type, bool has_receiver = true) {
  GstStructure* s = gst_structure_new_empty(GST_LIDAR_SLICES_RECEIVED_EVENT);
  if (has_receiver) gst_structure_set(s, "receiver", G_TYPE_UINT, 1U, nullptr);
  GValue list = G_VALUE_INIT;
  gst_value_array_init(&list, count);
  for (guint i = 0; i < count; ++i) {
    GValue number = G_VALUE_INIT;
    g_value_init(&number, type);
    gst_value_array_append_and_take_value(&list, &number);
  }
  gst_structure_take_value(s, "slices", &list);
  return EventPtr(gst_event_new_custom(GST_EVENT_CUSTOM_UPSTREAM, s));
}

TEST(Events, OfReceiptsAreReadUpToTheMostAndRefusedWhereTheyAreNone) {
  constexpr guint kMost = GST_LIDAR_MAX_RECEIVED;
  GstLidarSlicesReceived read{};
  for (const auto& [numbers, pairs] :
       {std::pair(0U, 0U), std::pair(1U, 0U), std::pair(3U, 1U), std::pair(2 * kMost, kMost),
        std::pair(2 * kMost + 1, kMost), std::pair(2 * kMost + 100, kMost)}) {
    ASSERT_TRUE(
        gst_lidar_event_parse_slices_received(SlicesEvent(numbers, G_TYPE_UINT).get(), &read));
    EXPECT_EQ(read.count, pairs) << numbers;
  }
  EXPECT_FALSE(gst_lidar_event_parse_slices_received(SlicesEvent(2, G_TYPE_INT).get(), &read));
  EXPECT_FALSE(
      gst_lidar_event_parse_slices_received(SlicesEvent(2, G_TYPE_UINT, false).get(), &read));
  const EventPtr without(
      gst_event_new_custom(GST_EVENT_CUSTOM_UPSTREAM,
                           gst_structure_new(GST_LIDAR_SLICES_RECEIVED_EVENT, "receiver",
                                             G_TYPE_UINT, 1U, "slices", G_TYPE_UINT, 2U, nullptr)));
  EXPECT_FALSE(gst_lidar_event_parse_slices_received(without.get(), &read));
}

}  // namespace
}  // namespace lidar::gst
