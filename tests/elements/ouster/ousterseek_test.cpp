// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of ouster_src on captures: the duration, and seeks.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <mutex>

#include "tests/elements/ouster/ouster_support.h"
#include "tests/support/patience.h"

namespace lidar::test {
namespace {

using gst::BufferMap;
using gst::BufferPtr;
using gst::ElementPtr;
using gst::EventPtr;

constexpr GstClockTime kSlice = 12500 * GST_USECOND;

/// The parts of a slice that must not depend on the position from which the file is played.
struct Played {
  GstClockTime pts = 0;
  GstClockTime captured = 0;
  guint index = 0;
  std::vector<guint8> points;

  bool operator==(const Played& o) const {
    return pts == o.pts && captured == o.captured && index == o.index && points == o.points;
  }
};

Harness Open(const std::string& location, const char* more = "") {
  Harness h(gst_harness_new_parse(("ouster_src location=" + location +
                                   " metadata=" + DataPath(kThreeScansMetadata) + " " + more)
                                      .c_str()));
  SetPlaying(h.get());
  return h;
}

/// Plays to the end of the stream. Returns the slices that were played.
std::vector<Played> PlayOn(const Harness& h) {
  for (bool ended = false; !ended;) {
    const EventPtr event(gst_harness_pull_event(h.get()));
    EXPECT_TRUE(event);
    ended = !event || GST_EVENT_TYPE(event.get()) == GST_EVENT_EOS;
  }
  std::vector<Played> slices;
  while (const BufferPtr buffer{gst_harness_try_pull(h.get())}) {
    const BufferMap map(buffer.get(), GST_MAP_READ);
    GstLidarSlice slice{};
    EXPECT_TRUE(gst_lidar_buffer_get_slice(buffer.get(), &slice));
    slices.push_back({GST_BUFFER_PTS(buffer.get()),
                      gst_lidar_buffer_get_capture_time(buffer.get()),
                      slice.slice_index,
                      {map.data(), map.data() + map.size()}});
  }
  return slices;
}

struct Range {
  gint64 start = 0;
  gint64 stop = -1;  // -1: none
  GstSeekType start_type = GST_SEEK_TYPE_SET;
  GstSeekType stop_type = GST_SEEK_TYPE_SET;
};

bool Seek(const Harness& h, const Range& range, gdouble rate = 1) {
  const GstSeekType stop_type = range.stop == -1 ? GST_SEEK_TYPE_NONE : range.stop_type;
  return gst_element_seek(h->element, rate, GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, range.start_type,
                          range.start, stop_type, range.stop) != FALSE;
}

std::vector<Played> After(const std::vector<Played>& all, std::size_t n) {
  return {all.begin() + static_cast<std::ptrdiff_t>(n), all.end()};
}

/// Writes the frames of a pcap file as pcapng, once with timestamps in microseconds, and once in
/// nanoseconds.
std::string WritePcapNg(const std::string& pcap) {
  const std::string bytes = ReadFile(pcap);
  const auto at = [&](std::size_t i) {
    guint32 value = 0;
    std::memcpy(&value, bytes.data() + i, sizeof value);
    return value;
  };
  std::string out;
  const auto put = [&](std::initializer_list<guint32> words) {
    for (const guint32 w : words) out.append(reinterpret_cast<const char*>(&w), sizeof w);
  };
  put({0x0a0d0d0a, 28, 0x1a2b3c4d, 1, 0xffffffff, 0xffffffff, 28});
  put({1, 20, at(20), at(16), 20});
  const bool nanoseconds = at(0) == 0xa1b23c4d;
  for (std::size_t i = 24; i + 16 <= bytes.size();) {
    const guint32 size = at(i + 8);
    const guint32 padded = (size + 3) / 4 * 4;
    const guint64 us = guint64{at(i)} * 1000000 + (nanoseconds ? at(i + 4) / 1000 : at(i + 4));
    put({6, padded + 32, 0, static_cast<guint32>(us >> 32), static_cast<guint32>(us), size,
         at(i + 12)});
    out += bytes.substr(i + 16, size) + std::string(padded - size, '\0');
    put({padded + 32});
    i += 16 + size;
  }
  const std::string path = ::testing::TempDir() + "ouster_seek.pcapng";
  std::ofstream(path, std::ios::binary) << out;
  return path;
}

TEST(OusterSeek, TellsTheDurationOfACapture) {
  const Harness h = Open(DataPath(kThreeScans));
  const auto all = PlayOn(h);
  gint64 duration = 0;
  ASSERT_TRUE(gst_element_query_duration(h->element, GST_FORMAT_TIME, &duration));
  EXPECT_NEAR(static_cast<double>(duration), static_cast<double>(all.back().pts + kSlice), 2e6);
  const auto times = TimesOf(kThreeScans);
  const Duration last_packet = LoadMetadata(kThreeScansMetadata).packet_interval();
  EXPECT_EQ(duration, (times.back() - times.front() + last_packet).count());
  GstQuery* query = gst_query_new_seeking(GST_FORMAT_TIME);
  ASSERT_TRUE(gst_element_query(h->element, query));
  gboolean seekable = FALSE;
  gint64 end = 0;
  gst_query_parse_seeking(query, nullptr, &seekable, nullptr, &end);
  gst_query_unref(query);
  EXPECT_TRUE(seekable);
  EXPECT_EQ(end, duration);
}

TEST(OusterSeek, GoesToTheSliceOfATimeAndPlaysTheSameFromThere) {
  const Harness h = Open(DataPath(kThreeScans));
  const auto all = PlayOn(h);
  ASSERT_EQ(all.size(), 24U);
  for (const std::size_t n : {23U, 5U, 12U, 0U, 20U}) {
    // Seeks to the beginning of slice n, and to its middle.
    for (const GstClockTime into : {GstClockTime{0}, kSlice / 2}) {
      ASSERT_TRUE(Seek(h, {static_cast<gint64>(all[n].pts + into)}));
      const auto rest = PlayOn(h);
      // Slices may overlap, because the sensor's motor jitters. Therefore one more slice may be
      // played.
      ASSERT_GE(rest.size(), 24 - n);
      ASSERT_LE(rest.size(), 25 - n);
      EXPECT_TRUE(After(rest, rest.size() - (24 - n)) == After(all, n)) << n;
    }
  }
  // A slice that ends exactly where the segment begins is not played.
  ASSERT_TRUE(Seek(h, {static_cast<gint64>(all[4].pts + kSlice)}));
  EXPECT_TRUE(PlayOn(h) == After(all, 5));
}

TEST(OusterSeek, GoesAnywhereInAPcapNgFileToo) {
  const std::string path = WritePcapNg(DataPath(kThreeScans));
  const Harness h = Open(path);
  const auto all = PlayOn(h);
  ASSERT_EQ(all.size(), 24U);
  gint64 duration = 0;
  ASSERT_TRUE(gst_element_query_duration(h->element, GST_FORMAT_TIME, &duration));
  EXPECT_NEAR(static_cast<double>(duration), static_cast<double>(all.back().pts + kSlice), 2e6);
  for (const std::size_t n : {15U, 3U}) {
    ASSERT_TRUE(Seek(h, {static_cast<gint64>(all[n].pts + kSlice / 2)}));
    EXPECT_TRUE(PlayOn(h) == After(all, n)) << n;
  }
  std::remove(path.c_str());
}

TEST(OusterSeek, EndsAtTheStop) {
  const Harness h = Open(DataPath(kThreeScans));
  const auto all = PlayOn(h);
  ASSERT_TRUE(Seek(h, {static_cast<gint64>(all[8].pts + kSlice / 2),
                       static_cast<gint64>(all[11].pts + kSlice / 2)}));
  const auto part = PlayOn(h);
  ASSERT_EQ(part.size(), 4U);
  EXPECT_TRUE(part.front() == all[8]);
  EXPECT_TRUE(part.back() == all[11]);
}

TEST(OusterSeek, CountsFromTheEnd) {
  const Harness h = Open(DataPath(kThreeScans));
  PlayOn(h);
  ASSERT_TRUE(Seek(h, {-static_cast<gint64>(4 * kSlice), -1, GST_SEEK_TYPE_END}));
  const auto rest = PlayOn(h);
  EXPECT_GE(rest.size(), 4U);
  EXPECT_LE(rest.size(), 5U);
}

TEST(OusterSeek, StopsBeforeTheEnd) {
  const Harness h = Open(DataPath(kThreeScans));
  const auto all = PlayOn(h);
  ASSERT_EQ(all.size(), 24U);
  // The stop lies in the middle of the fifth slice from the end.
  ASSERT_TRUE(Seek(
      h, {0, -static_cast<gint64>(4 * kSlice + kSlice / 2), GST_SEEK_TYPE_SET, GST_SEEK_TYPE_END}));
  const auto part = PlayOn(h);
  ASSERT_EQ(part.size(), 20U);
  EXPECT_TRUE(part.front() == all.front());
  EXPECT_TRUE(part.back() == all[19]);
}

TEST(OusterSeek, BeyondTheEndThereIsNothing) {
  const Harness h = Open(DataPath(kThreeScans));
  PlayOn(h);
  ASSERT_TRUE(Seek(h, {static_cast<gint64>(3600 * GST_SECOND)}));
  EXPECT_TRUE(PlayOn(h).empty());
}

TEST(OusterSeek, MayComeBeforeThePlayback) {
  const Harness first = Open(DataPath(kThreeScans));
  const auto all = PlayOn(first);
  const Harness h(gst_harness_new("ouster_src"));
  g_object_set(h->element, "location", DataPath(kThreeScans).c_str(), "metadata",
               DataPath(kThreeScansMetadata).c_str(), nullptr);
  gst_element_set_state(h->element, GST_STATE_READY);
  ASSERT_TRUE(Seek(h, {static_cast<gint64>(all[9].pts + kSlice / 2)}));
  SetPlaying(h.get());
  EXPECT_TRUE(PlayOn(h) == After(all, 9));
}

TEST(OusterSeek, NeitherBackwardsNorLiveNorInALoop) {
  const Harness h = Open(DataPath(kThreeScans));
  PlayOn(h);
  EXPECT_FALSE(Seek(h, {0}, -1.0));
  for (const char* more : {"is-live=true", "loop=true num-buffers=3"}) {
    const Harness other = Open(DataPath(kThreeScans), more);
    EXPECT_FALSE(Seek(other, {0})) << more;
    gint64 duration = 0;
    EXPECT_FALSE(gst_element_query_duration(other->element, GST_FORMAT_TIME, &duration)) << more;
  }
}

/// The start of the newest segment at a pad, and the times of the buffers in this segment.
struct Seen {
  std::mutex mutex;
  GstClockTime start = 0;
  std::vector<GstClockTime> times;
  guint flushes = 0;
};

GstPadProbeReturn Watch(GstPad*, GstPadProbeInfo* info, gpointer data) {
  auto* seen = static_cast<Seen*>(data);
  const std::lock_guard lock(seen->mutex);
  if ((info->type & GST_PAD_PROBE_TYPE_BUFFER) != 0) {
    seen->times.push_back(GST_BUFFER_PTS(GST_PAD_PROBE_INFO_BUFFER(info)));
    return GST_PAD_PROBE_OK;
  }
  GstEvent* event = GST_PAD_PROBE_INFO_EVENT(info);
  if (GST_EVENT_TYPE(event) == GST_EVENT_FLUSH_STOP) ++seen->flushes;
  if (GST_EVENT_TYPE(event) != GST_EVENT_SEGMENT) return GST_PAD_PROBE_OK;
  const GstSegment* segment = nullptr;
  gst_event_parse_segment(event, &segment);
  seen->start = segment->start;
  seen->times.clear();
  return GST_PAD_PROBE_OK;
}

void WatchSink(GstElement* pipeline, const char* name, Seen* seen) {
  const ElementPtr sink(gst_bin_get_by_name(GST_BIN(pipeline), name));
  GstPad* pad = gst_element_get_static_pad(sink.get(), "sink");
  gst_pad_add_probe(
      pad,
      static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM |
                                   GST_PAD_PROBE_TYPE_EVENT_FLUSH),
      Watch, seen, nullptr);
  gst_object_unref(pad);
}

void AwaitEnd(GstElement* pipeline) {
  const ElementBus bus(pipeline);
  const gst::MessagePtr message = bus.Wait(GST_MESSAGE_EOS | GST_MESSAGE_ERROR);
  ASSERT_TRUE(message);
  ASSERT_EQ(GST_MESSAGE_TYPE(message.get()), GST_MESSAGE_EOS);
}

TEST(OusterSeek, TakesTheImuAlongOnce) {
  Seen clouds;
  Seen samples;
  const ElementPtr pipeline(
      gst_parse_launch(("ouster_src name=s location=" + DataPath(kThreeScans) +
                        " metadata=" + DataPath(kThreeScansMetadata) +
                        " s.src ! queue ! fakesink name=clouds sync=false async=false"
                        " s.imu ! queue ! fakesink name=samples sync=false async=false")
                           .c_str(),
                       nullptr));
  WatchSink(pipeline.get(), "clouds", &clouds);
  WatchSink(pipeline.get(), "samples", &samples);
  gst_element_set_state(pipeline.get(), GST_STATE_PLAYING);
  AwaitEnd(pipeline.get());
  const std::vector<GstClockTime> first_pass = samples.times;
  const auto all = static_cast<guint>(first_pass.size());
  const GstClockTime middle = 150 * GST_MSECOND;
  ASSERT_TRUE(gst_element_seek_simple(pipeline.get(), GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH,
                                      static_cast<gint64>(middle)));
  AwaitEnd(pipeline.get());
  for (Seen* seen : {&clouds, &samples}) {
    EXPECT_EQ(seen->start, middle);
    EXPECT_EQ(seen->flushes, 1U);
    ASSERT_FALSE(seen->times.empty());
  }
  EXPECT_NEAR(static_cast<double>(samples.times.size()), all / 2.0, 2.0);
  EXPECT_GE(samples.times.front(), middle);
  // The samples have the same times as in the first pass, but begin later.
  ASSERT_LE(samples.times.size(), first_pass.size());
  EXPECT_TRUE(std::equal(samples.times.rbegin(), samples.times.rend(), first_pass.rbegin()));
  gst_element_set_state(pipeline.get(), GST_STATE_NULL);
}

}  // namespace
}  // namespace lidar::test
