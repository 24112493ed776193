// SPDX-License-Identifier: LGPL-2.1-or-later
// Compares what the payloader and the depayloader output, send and post in scripted runs with
// golden files.
#include <gtest/gtest.h>

#include "tests/elements/rtplidar/slices.h"
#include "tests/support/golden_course.h"

namespace lidar::test {
namespace {

GstLidarTargetBitrate Target(guint bps) {
  GstLidarTargetBitrate target{};
  target.bitrate = bps;
  target.min_bitrate = bps / 2;
  target.max_bitrate = 2 * bps;
  return target;
}

gst::BufferPtr Bare(gst::BufferPtr slice) {
  return gst::BufferPtr(
      gst_buffer_copy_region(slice.get(), GST_BUFFER_COPY_MEMORY, 0, static_cast<gsize>(-1)));
}

/// Sends an event that says that some packets arrived. `first` and `last` count back from the
/// newest packet.
void Tell(Course& c, guint receiver, guint first, guint last) {
  guint newest = 0;
  g_object_get(c.element(), "seqnum", &newest, nullptr);
  GstLidarPacketsReceived received{};
  received.receiver = receiver;
  received.ssrc = static_cast<guint>(c.Stat("ssrc"));
  received.count = 1;
  received.ranges[0] = {static_cast<guint16>(newest - first), static_cast<guint16>(newest - last)};
  c.PushUpstream("packets received", gst_lidar_event_new_packets_received(&received));
}

void PayCourse(Course& c) {
  const auto slice = [](guint scan, guint index, gsize size) {
    return gst::BufferPtr(EncodedSlice(scan, index, size));
  };
  c.Ask();
  c.Tag();
  c.Begin(EncodedCaps());
  const GstLidarBitrateBounds bounds{1'000'000, 2'000'000, 1'500'000};
  c.PushEvent("bounds", gst_lidar_event_new_bitrate_bounds(&bounds));
  for (guint i = 0; i < kSlices; ++i) c.Push("a slice", slice(0, i, 100 + 700 * i));
  c.Ask();
  Tell(c, 7, 7, 3);
  Tell(c, 7, 1, 0);
  Tell(c, 7, 2, 2);
  const GstLidarTargetBitrate target = Target(500'000);
  c.PushUpstream("target", gst_lidar_event_new_target_bitrate(&target));
  c.Unknown();
  c.Push("an empty one", slice(1, 0, 0));
  c.Push("behind skipped ones", slice(1, 3, 300));
  c.Push("behind a skipped scan", slice(3, 0, 300));
  c.Push("without a meta", Bare(slice(4, 0, 300)));
  c.Gap(450 * GST_MSECOND, GST_MSECOND);
  c.PushUpstream("key unit", gst_event_new_custom(GST_EVENT_CUSTOM_UPSTREAM,
                                                  gst_structure_new_empty("GstForceKeyUnit")));
  c.Push("behind a request", slice(5, 0, 200));
  c.SetCaps(EncodedCaps("range", 20));
  c.Push("of other caps", slice(5, 1, 200));
  c.Push("after the interval", slice(17, 0, 200));
  c.Push("in its scan", slice(17, 1, 200));
  c.PushSegment(GST_FORMAT_TIME, 1'750 * GST_MSECOND);
  c.Push("in a segment", slice(17, 2, 200));
  c.Flush();
  c.Push("behind a flush", slice(17, 3, 200));
  c.Set("config-interval", "0");
  c.Push("without repetitions", slice(40, 0, 200));
  c.Set("aggregate", "true");
  c.Ask();
  gint64 held = 0;
  g_object_get(c.harness()->element, "max-ptime", &held, nullptr);
  c.Set("max-ptime", "30000000");
  c.Ask();
  c.Set("max-ptime", std::to_string(held).c_str());
  for (guint i = 1; i < kSlices; ++i) c.Push("together", slice(40, i, 90));
  c.Push("together", slice(41, 0, 90));
  c.Set("aggregate", "false");
  c.Push("alone", slice(41, 1, 90));
  c.Push("before the end", slice(41, 2, 90));
  const GstLidarBitrateBounds others{2'000'000, 3'000'000, 2'500'000};
  c.PushEvent("other bounds", gst_lidar_event_new_bitrate_bounds(&others));
  auto odd = slice(42, 0, 200);
  const GstLidarSlice meta{42, 4, 4, 0};
  gst_lidar_buffer_set_slice(odd.get(), &meta);
  c.Push("out of range", std::move(odd));
  c.End();
  c.Stop();
  c.Begin(EncodedCaps());
  c.Push("in a second run", slice(0, 0, 500));
  c.SetCaps("application/x-lidar-slice,geometry=range,alignment=slice");
  c.End();
}

std::vector<gst::BufferPtr> CoursePackets(guint scans, gsize size, bool aggregate = false) {
  g_random_set_seed(2);
  return Packets(scans, size, aggregate);
}

gst::BufferPtr Copy(const gst::BufferPtr& packet) {
  return gst::BufferPtr(gst_buffer_copy_deep(packet.get()));
}

void DepayCourse(Course& c) {
  const auto packets = CoursePackets(12, 2'600);
  const auto others = [] {
    g_random_set_seed(3);
    return Packets(14, 2'600);
  }();
  c.Ask();
  c.Tag();
  c.Begin(kRtpCaps);
  c.Push("no RTP", gst::BufferPtr(gst_buffer_new_memdup("none", 4)));
  for (std::size_t i = 1; i < 4; ++i) c.Push("before the config", Copy(packets[i]));
  c.Push("the config", Copy(packets[0]));
  for (std::size_t i = 4; i < 9; ++i) c.Push("in order", Copy(packets[i]));
  for (const std::size_t i : {11U, 9U, 10U, 12U}) c.Push("in disorder", Copy(packets[i]));
  c.Push("twice", Copy(packets[12]));
  c.Ask();
  c.Unknown();
  for (const std::size_t i : {14U, 15U, 16U, 17U}) c.Push("behind a loss", Copy(packets[i]));
  c.PushEvent("lost packet",
              gst_event_new_custom(
                  GST_EVENT_CUSTOM_DOWNSTREAM,
                  gst_structure_new("GstRTPPacketLost", "seqnum", G_TYPE_UINT, 5U, "timestamp",
                                    GST_TYPE_CLOCK_TIME, 50 * GST_MSECOND, "duration",
                                    GST_TYPE_CLOCK_TIME, 10 * GST_MSECOND, nullptr)));
  c.Gap(450 * GST_MSECOND, GST_MSECOND);
  c.Push("late", Copy(packets[13]));
  auto damaged = Copy(packets[18]);
  gst_buffer_memset(damaged.get(), gst_buffer_get_size(damaged.get()) - 1, 0x55, 1);
  c.Push("damaged", std::move(damaged));
  for (std::size_t i = 19; i < 30; ++i) c.Push("in order", Copy(packets[i]));
  for (const auto& packet : WithType(CoursePackets(1, 500), 111))
    c.Push("of another type", Copy(packet));
  c.Set("max-reorder-time", "10000000");
  for (std::size_t i = 32; i < 40; ++i) c.Push("behind a loss", Copy(packets[i]));
  c.Push("late", Copy(packets[31]));
  c.Flush();
  for (std::size_t i = 40; i < 46; ++i) c.Push("behind a flush", Copy(packets[i]));
  c.PushSegment(GST_FORMAT_TIME, GST_SECOND);
  for (std::size_t i = 0; i < 40; ++i) {
    c.Push("of another sender", Copy(others[i]));
    if (i % 4 == 0) c.Push("of the first one", Copy(packets[46 + i / 4]));
  }
  for (std::size_t i = 40; i < others.size(); ++i)
    c.Push("of another sender alone", Copy(others[i]));
  c.SetCaps(std::string(kRtpCaps) + ",a-x=1");
  c.End();
  c.Stop();
  c.Begin(kRtpCaps);
  for (std::size_t i = 0; i < 8; ++i) c.Push("in a second run", Copy(packets[i]));
  c.End();
}

void AggregatesCourse(Course& c) {
  const auto packets = CoursePackets(6, 150, true);
  c.Begin(kRtpCaps);
  for (std::size_t i = 0; i < packets.size(); ++i)
    if (i != 3) c.Push("an aggregate", Copy(packets[i]));
  c.End();
}

/// Downstream first refuses the caps. Later it accepts them.
void RefusedCourse(Course& c) {
  const auto packets = CoursePackets(4, 300);
  gst_harness_set_sink_caps_str(c.harness(), "application/x-other");
  c.Begin(kRtpCaps);
  for (std::size_t i = 0; i < 4; ++i) c.Push("not taken", Copy(packets[i]));
  gst_harness_set_sink_caps_str(c.harness(), "ANY");
  for (std::size_t i = 4; i < packets.size(); ++i) c.Push("taken", Copy(packets[i]));
  c.End();
}

const std::size_t kRtpCourses = AddGoldenCourses(
    "RtpGoldenCourses",
    {
        {"pay", "rtplidarpay mtu=1000", PayCourse},
        {"pay_together", "rtplidarpay aggregate=true max-ptime=60000000 config-interval=2",
         PayCourse},
        {"pay_numbers", "rtplidarpay pt=100 ssrc=5 seqnum-offset=65530 timestamp-offset=9",
         PayCourse},
        {"depay", "rtplidardepay", DepayCourse},
        {"depay_at_once", "rtplidardepay max-reorder-time=0", DepayCourse},
        {"depay_aggregates", "rtplidardepay", AggregatesCourse},
        {"depay_refused", "rtplidardepay", RefusedCourse},
    },
    GOLDEN_COURSES_FOLDER);

}  // namespace
}  // namespace lidar::test
