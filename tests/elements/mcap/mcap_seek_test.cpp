// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of seeks and segments of mcapsrc.
#include <atomic>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "ext/mcap/seeking.h"
#include "gst/common/seek_range.h"
#include "tests/elements/mcap/recording.h"
#include "tests/support/patience.h"

namespace lidar::test {
namespace {

class McapSeek : public Recording {};

/// Returns the position of the pipeline `p` and the duration of its recording.
std::pair<gint64, gint64> Times(const Pipeline& p) {
  std::pair<gint64, gint64> times{-1, -1};
  gst_element_query_position(p.get(), GST_FORMAT_TIME, &times.first);
  gst_element_query_duration(p.get(), GST_FORMAT_TIME, &times.second);
  return times;
}

TEST_F(McapSeek, AFlushDropsAnEosOfTheApplication) {
  const auto written = Record(4, "", "a.mcap");
  Pipeline p("mcapsrc name=m" + At("a.mcap") + " ! fakesink name=see");
  gst_element_set_state(p.get(), GST_STATE_PAUSED);
  ASSERT_TRUE(p.Wait(GST_MESSAGE_ASYNC_DONE));
  ASSERT_TRUE(gst_element_send_event(p.get(), gst_event_new_eos()));
  gst_element_set_state(p.get(), GST_STATE_PLAYING);
  ASSERT_TRUE(p.Wait(GST_MESSAGE_EOS));
  p.Forget();
  ASSERT_TRUE(gst_element_seek_simple(p.get(), GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, 0));
  ASSERT_TRUE(p.Wait(GST_MESSAGE_EOS));
  ExpectSame(p.outcome().buffers["see"], written);
}

TEST_F(McapSeek, SeeksByTime) {
  const auto written = Record(20, "chunk-duration=300000000", "a.mcap");
  Pipeline p("mcapsrc name=m" + At("a.mcap") + " ! fakesink name=see");
  gst_element_set_state(p.get(), GST_STATE_PAUSED);
  ASSERT_TRUE(p.Wait(GST_MESSAGE_ASYNC_DONE));
  const auto length = static_cast<gint64>(written.back().pts - written.front().pts);
  EXPECT_EQ(Times(p).second, length);
  for (const gint64 to : {1'210 * GST_MSECOND, 50 * GST_MSECOND, gint64{0}}) {
    p.Forget();
    ASSERT_TRUE(gst_element_seek_simple(p.get(), GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, to));
    ASSERT_TRUE(p.Wait(GST_MESSAGE_ASYNC_DONE));
    EXPECT_EQ(Times(p).first, to);
  }
  p.Forget();
  const gint64 from = 1'210 * GST_MSECOND;
  ASSERT_TRUE(gst_element_seek(p.get(), 2, GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, GST_SEEK_TYPE_SET,
                               from, GST_SEEK_TYPE_SET, from + 200 * GST_MSECOND));
  gst_element_set_state(p.get(), GST_STATE_PLAYING);
  ASSERT_TRUE(p.Wait(GST_MESSAGE_EOS));
  const auto played = p.outcome().buffers.at("see");
  ASSERT_EQ(played.size(), 16U);  // each slice is 12.5 ms long
  EXPECT_GE(played.front().pts, static_cast<GstClockTime>(from));
  EXPECT_LT(played.front().pts, static_cast<GstClockTime>(from) + 13 * GST_MSECOND);
  EXPECT_TRUE(played.front().discont);
  // A seek to 0 after EOS plays the whole recording again.
  p.Forget();
  ASSERT_TRUE(gst_element_seek_simple(p.get(), GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, 0));
  ASSERT_TRUE(p.Wait(GST_MESSAGE_EOS));
  ExpectSame(p.outcome().buffers.at("see"), written);
  gint64 position = 0;
  ASSERT_TRUE(gst_element_query_position(p.Find("m").get(), GST_FORMAT_TIME, &position));
  EXPECT_EQ(position, length);
  // A seek with a negative rate is refused.
  EXPECT_FALSE(gst_element_seek(p.get(), -1, GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH,
                                GST_SEEK_TYPE_SET, 0, GST_SEEK_TYPE_NONE, 0));
}

/// Streams may have different delays. Therefore a file may begin before the end of the previous
/// file.
TEST_F(McapSeek, PlaysAllBeforeTheEndWhereFilesOverlap) {
  for (const int file : {0, 1}) {
    const Harness h = RecordingTo(Path("rec-" + std::to_string(file) + ".mcap"));
    gst_harness_set_src_caps_str(h.get(), "application/x-lidar-slice,alignment=slice");
    for (const guint ms : {0U, 10U, 200U}) {
      GstBuffer* buffer = gst_buffer_new_memdup("s", 1);
      GST_BUFFER_PTS(buffer) = (ms + (file == 0 ? 0 : 100)) * GST_MSECOND;
      gst_lidar_buffer_set_capture_time(buffer, kCapture + GST_BUFFER_PTS(buffer));
      EXPECT_EQ(gst_harness_push(h.get(), buffer), GST_FLOW_OK);
    }
    gst_harness_push_event(h.get(), gst_event_new_eos());
  }
  Pipeline p("mcapsrc" + At("rec-%d.mcap") + " ! fakesink name=see");
  gst_element_set_state(p.get(), GST_STATE_PAUSED);
  ASSERT_TRUE(p.Wait(GST_MESSAGE_ASYNC_DONE));
  p.Forget();
  ASSERT_TRUE(gst_element_seek(p.get(), 1, GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, GST_SEEK_TYPE_SET,
                               0, GST_SEEK_TYPE_SET, 110 * GST_MSECOND));
  gst_element_set_state(p.get(), GST_STATE_PLAYING);
  ASSERT_TRUE(p.Wait(GST_MESSAGE_EOS));
  const Outcome outcome = p.outcome();
  std::vector<GstClockTime> shown;
  for (const Kept& kept : outcome.buffers.at("see")) shown.push_back(kept.pts / GST_MSECOND);
  EXPECT_EQ(shown, (std::vector<GstClockTime>{0, 10, 100}));
}

TEST_F(McapSeek, RefusesToEndBeforeItBegins) {
  Play(kSensor + " num-buffers=80 ! lidarenc ! mcapsink" + At("a.mcap"));
  Pipeline p("mcapsrc" + At("a.mcap") + " ! fakesink name=see");
  gst_element_set_state(p.get(), GST_STATE_PAUSED);
  gst_element_get_state(p.get(), nullptr, nullptr, GST_CLOCK_TIME_NONE);
  const auto seek = [&](GstSeekType start_type, gint64 start, GstSeekType stop_type, gint64 stop) {
    return gst_element_seek(p.get(), 1, GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, start_type, start,
                            stop_type, stop);
  };
  constexpr auto kMs = gint64{GST_MSECOND};
  EXPECT_FALSE(seek(GST_SEEK_TYPE_SET, 600 * kMs, GST_SEEK_TYPE_SET, 200 * kMs));
  EXPECT_FALSE(seek(GST_SEEK_TYPE_SET, 600 * kMs, GST_SEEK_TYPE_END, -900 * kMs));
  EXPECT_TRUE(seek(GST_SEEK_TYPE_END, -200 * kMs, GST_SEEK_TYPE_NONE, 0));
  EXPECT_EQ(p.Run().error, "");
}

/// Records, for each segment that arrives at a sink, the running time at which it starts [ms].
class SegmentTimes {
 public:
  explicit SegmentTimes(GstElement* sink) : pad_(gst_element_get_static_pad(sink, "sink")) {
    probe_ = gst_pad_add_probe(
        pad_.get(), GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM,
        [](GstPad*, GstPadProbeInfo* info, gpointer self) {
          if (GST_EVENT_TYPE(info->data) == GST_EVENT_SEGMENT)
            static_cast<SegmentTimes*>(self)->Keep(GST_PAD_PROBE_INFO_EVENT(info));
          return GST_PAD_PROBE_OK;
        },
        this, nullptr);
  }
  ~SegmentTimes() { gst_pad_remove_probe(pad_.get(), probe_); }
  SegmentTimes(const SegmentTimes&) = delete;
  SegmentTimes& operator=(const SegmentTimes&) = delete;

  std::vector<GstClockTime> Take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(times_, {});
  }

 private:
  void Keep(GstEvent* event) {
    const GstSegment* segment = nullptr;
    gst_event_parse_segment(event, &segment);
    const std::lock_guard lock(mutex_);
    times_.push_back(gst_segment_to_running_time(segment, GST_FORMAT_TIME, segment->start) /
                     GST_MSECOND);
  }

  const gst::PadPtr pad_;
  gulong probe_ = 0;
  std::mutex mutex_;
  std::vector<GstClockTime> times_;
};

/// If the EOS that a pad returned in the last segment still counted, the next segment would end at
/// once, because the other pad is not linked.
TEST_F(McapSeek, ASegmentPlaysThoughTheOneBeforeEndedDownstream) {
  {
    const Harness h = RecordingTo(Path("a.mcap"));
    const Harness other(gst_harness_new_with_element(h->element, "sink_1", nullptr));
    for (GstHarness* stream : {h.get(), other.get()})
      gst_harness_set_src_caps_str(stream, "application/x-lidar-slice,alignment=slice");
    for (guint i = 0; i < 6; ++i) {
      GstBuffer* buffer = gst_buffer_new_memdup("s", 1);
      GST_BUFFER_PTS(buffer) = i * 10 * GST_MSECOND;
      gst_lidar_buffer_set_capture_time(buffer, kCapture + GST_BUFFER_PTS(buffer));
      // The stream that is not linked has the first message.
      GstHarness* const stream = i % 2 == 0 ? other.get() : h.get();
      EXPECT_EQ(gst_harness_push(stream, buffer), GST_FLOW_OK);
    }
    for (GstHarness* stream : {h.get(), other.get()})
      gst_harness_push_event(stream, gst_event_new_eos());
  }
  Pipeline p("mcapsrc" + At("a.mcap") +
             " ! identity name=gate ! fakesink name=see sync=false async=false");
  gst_element_set_state(p.get(), GST_STATE_PLAYING);
  ASSERT_TRUE(p.Wait(GST_MESSAGE_EOS));
  std::atomic<bool> shut{true};
  const gst::PadPtr gate(gst_element_get_static_pad(p.Find("gate").get(), "sink"));
  gst_pad_add_probe(
      gate.get(), GST_PAD_PROBE_TYPE_BUFFER,
      [](GstPad*, GstPadProbeInfo* info, gpointer data) {
        if (!static_cast<std::atomic<bool>*>(data)->exchange(false)) return GST_PAD_PROBE_OK;
        gst_buffer_unref(GST_PAD_PROBE_INFO_BUFFER(info));
        GST_PAD_PROBE_INFO_FLOW_RETURN(info) = GST_FLOW_EOS;
        return GST_PAD_PROBE_HANDLED;
      },
      &shut, nullptr);
  const std::pair<int, std::size_t> seeks[] = {{GST_SEEK_FLAG_FLUSH, 0}, {0, 3}, {0, 3}};
  for (const auto& [flags, shown] : seeks) {
    p.Forget();
    ASSERT_TRUE(gst_element_seek(p.get(), 1, GST_FORMAT_TIME,
                                 static_cast<GstSeekFlags>(flags | GST_SEEK_FLAG_SEGMENT),
                                 GST_SEEK_TYPE_SET, 0, GST_SEEK_TYPE_NONE, 0));
    ASSERT_TRUE(p.Wait(GST_MESSAGE_SEGMENT_DONE));
    EXPECT_EQ(p.outcome().buffers["see"].size(), shown);
  }
}

TEST_F(McapSeek, ASegmentSeekEndsWithItsMessage) {
  Record(10, "", "a.mcap");
  Pipeline p("mcapsrc" + At("a.mcap") + " ! identity name=see ! fakesink name=end");
  SegmentTimes segments(p.Find("end").get());
  gst_element_set_state(p.get(), GST_STATE_PAUSED);
  ASSERT_TRUE(p.Wait(GST_MESSAGE_ASYNC_DONE));
  p.Forget();
  const auto flags = static_cast<GstSeekFlags>(GST_SEEK_FLAG_FLUSH | GST_SEEK_FLAG_SEGMENT);
  ASSERT_TRUE(gst_element_seek(p.get(), 1, GST_FORMAT_TIME, flags, GST_SEEK_TYPE_SET, 0,
                               GST_SEEK_TYPE_SET, 300 * GST_MSECOND));
  gst_element_set_state(p.get(), GST_STATE_PLAYING);
  ASSERT_TRUE(p.Wait(GST_MESSAGE_SEGMENT_DONE));
  EXPECT_EQ(p.outcome().segment_done, 300 * GST_MSECOND);
  segments.Take();
  // The next segments follow without a flush, as if the recording were played in a loop.
  for (const GstSeekFlags next : {GST_SEEK_FLAG_SEGMENT, GST_SEEK_FLAG_NONE}) {
    ASSERT_TRUE(gst_element_seek(p.get(), 1, GST_FORMAT_TIME, next, GST_SEEK_TYPE_SET, 0,
                                 GST_SEEK_TYPE_SET, 300 * GST_MSECOND));
    ASSERT_TRUE(p.Wait(next == GST_SEEK_FLAG_SEGMENT ? GST_MESSAGE_SEGMENT_DONE : GST_MESSAGE_EOS));
  }
  EXPECT_EQ(p.outcome().buffers.at("see").size(), 72U);
  EXPECT_EQ(segments.Take(), (std::vector<GstClockTime>{300, 600})) << "without an overlap";
}

/// Records the types and sequence numbers of the events that a seek causes.
class EventNumbers {
 public:
  using Entry = std::pair<std::string, guint32>;

  void Watch(GstElement* sink) {
    const gst::PadPtr pad(gst_element_get_static_pad(sink, "sink"));
    const auto keep = [](GstPad*, GstPadProbeInfo* info, gpointer self) {
      static_cast<EventNumbers*>(self)->Keep(GST_PAD_PROBE_INFO_EVENT(info));
      return GST_PAD_PROBE_OK;
    };
    gst_pad_add_probe(pad.get(),
                      static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM |
                                                   GST_PAD_PROBE_TYPE_EVENT_FLUSH),
                      keep, this, nullptr);
  }
  /// Waits until there are `count` events. Returns the events.
  std::vector<Entry> Await(std::size_t count) {
    EXPECT_TRUE(Eventually([&] {
      const std::lock_guard lock(mutex_);
      return entries_.size() >= count;
    }));
    return Take();
  }
  std::vector<Entry> Take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(entries_, {});
  }

 private:
  void Keep(GstEvent* event) {
    switch (GST_EVENT_TYPE(event)) {
      case GST_EVENT_FLUSH_START:
      case GST_EVENT_FLUSH_STOP:
      case GST_EVENT_SEGMENT:
      case GST_EVENT_SEGMENT_DONE:
      case GST_EVENT_EOS: {
        const std::lock_guard lock(mutex_);
        entries_.emplace_back(GST_EVENT_TYPE_NAME(event), gst_event_get_seqnum(event));
        break;
      }
      default:
        break;
    }
  }

  std::mutex mutex_;
  std::vector<Entry> entries_;
};

TEST_F(McapSeek, TheEventsOfASeekHaveItsNumber) {
  Record(10, "", "a.mcap");
  EventNumbers numbers;
  Pipeline p("mcapsrc" + At("a.mcap") + " ! fakesink name=see");
  numbers.Watch(p.Find("see").get());
  gst_element_set_state(p.get(), GST_STATE_PLAYING);
  ASSERT_TRUE(p.Wait(GST_MESSAGE_EOS));
  const auto seek = [&](int flags, GstMessageType end) {
    p.Forget();
    numbers.Take();
    GstEvent* event = gst_event_new_seek(
        1, GST_FORMAT_TIME, static_cast<GstSeekFlags>(GST_SEEK_FLAG_FLUSH | flags),
        GST_SEEK_TYPE_SET, 0, GST_SEEK_TYPE_SET, 300 * GST_MSECOND);
    const guint32 number = gst_event_get_seqnum(event);
    EXPECT_TRUE(gst_element_send_event(p.get(), event));
    EXPECT_TRUE(p.Wait(end));
    return number;
  };
  using Entries = std::vector<EventNumbers::Entry>;
  guint32 n = seek(0, GST_MESSAGE_EOS);
  EXPECT_EQ(numbers.Await(4),
            (Entries{{"flush-start", n}, {"flush-stop", n}, {"segment", n}, {"eos", n}}));
  n = seek(GST_SEEK_FLAG_SEGMENT, GST_MESSAGE_SEGMENT_DONE);
  EXPECT_EQ(numbers.Await(4),
            (Entries{{"flush-start", n}, {"flush-stop", n}, {"segment", n}, {"segment-done", n}}));
}

TEST_F(McapSeek, SaysHowFarOneMaySeekAndWhatIsPlayed) {
  Record(10, "", "a.mcap");
  Pipeline p("mcapsrc name=m" + At("a.mcap") + " ! fakesink name=see");
  gst_element_set_state(p.get(), GST_STATE_PAUSED);
  ASSERT_TRUE(p.Wait(GST_MESSAGE_ASYNC_DONE));
  const gst::PadPtr pad(gst_element_get_static_pad(p.Find("m").get(), "src_0"));
  const gint64 length = Times(p).second;
  gboolean seekable = FALSE;
  gint64 start = -1, stop = -1;
  const gst::QueryPtr seeking(gst_query_new_seeking(GST_FORMAT_TIME));
  ASSERT_TRUE(gst_pad_query(pad.get(), seeking.get()));
  gst_query_parse_seeking(seeking.get(), nullptr, &seekable, &start, &stop);
  EXPECT_TRUE(seekable);
  EXPECT_EQ(start, 0);
  EXPECT_EQ(stop, length);
  for (GstQuery* query :
       {gst_query_new_seeking(GST_FORMAT_BYTES), gst_query_new_duration(GST_FORMAT_BYTES),
        gst_query_new_position(GST_FORMAT_BYTES)}) {
    const gst::QueryPtr owner(query);
    EXPECT_FALSE(gst_pad_query(pad.get(), query)) << GST_QUERY_TYPE_NAME(query);
  }
  for (const gint64 end : {gint64{-1}, gint64{500 * GST_MSECOND}}) {
    ASSERT_TRUE(gst_element_seek(p.get(), 2, GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH,
                                 GST_SEEK_TYPE_SET, 300 * GST_MSECOND, GST_SEEK_TYPE_SET, end));
    ASSERT_TRUE(p.Wait(GST_MESSAGE_ASYNC_DONE));
    gdouble rate = 0;
    const gst::QueryPtr segment(gst_query_new_segment(GST_FORMAT_TIME));
    ASSERT_TRUE(gst_pad_query(pad.get(), segment.get()));
    gst_query_parse_segment(segment.get(), &rate, nullptr, &start, &stop);
    EXPECT_EQ(rate, 2);
    EXPECT_EQ(start, 300 * GST_MSECOND);
    EXPECT_EQ(stop, end < 0 ? length : end);
  }
}

/// A pipeline sends a seek event to each of its sinks, and each sink sends it upstream.
TEST_F(McapSeek, IsDoneOnceHoweverManySinksSendIt) {
  const std::string sensor = kSensor + " num-buffers=16 ! lidarenc ! m. ";
  Play("mcapsink name=m" + At("a.mcap") + sensor + sensor + sensor);
  Pipeline p("mcapsrc name=s" + At("a.mcap") +
             " s.src_0 ! queue ! fakesink name=see0 s.src_1 ! queue ! fakesink name=see1 s.src_2 ! "
             "queue ! fakesink name=see2");
  gst_element_set_state(p.get(), GST_STATE_PAUSED);
  ASSERT_TRUE(p.Wait(GST_MESSAGE_ASYNC_DONE));
  std::atomic<int> flushes{0};
  for (const char* name : {"src_0", "src_1", "src_2"}) {
    const gst::PadPtr pad(gst_element_get_static_pad(p.Find("s").get(), name));
    gst_pad_add_probe(
        pad.get(), GST_PAD_PROBE_TYPE_EVENT_FLUSH,
        [](GstPad*, GstPadProbeInfo* info, gpointer count) {
          if (GST_EVENT_TYPE(info->data) == GST_EVENT_FLUSH_STOP)
            ++*static_cast<std::atomic<int>*>(count);
          return GST_PAD_PROBE_OK;
        },
        &flushes, nullptr);
  }
  for (int seek = 1; seek <= 3; ++seek) {
    p.Forget();
    ASSERT_TRUE(gst_element_seek_simple(p.get(), GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH,
                                        (50 - 10 * seek) * GST_MSECOND));
    ASSERT_TRUE(p.Wait(GST_MESSAGE_ASYNC_DONE));
    EXPECT_EQ(flushes, 3 * seek) << "one for each pad";
  }
}

/// Records the times of the buffers that a sink has received since the last flush. Blocks the sink
/// at a buffer whose time is `closed_from` or later, until Open() is called.
class Gate {
 public:
  explicit Gate(GstClockTime closed_from) : closed_from_(closed_from) {}

  void Guard(GstElement* sink) {
    const gst::PadPtr pad(gst_element_get_static_pad(sink, "sink"));
    gst_pad_add_probe(
        pad.get(),
        static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_EVENT_FLUSH),
        [](GstPad*, GstPadProbeInfo* info, gpointer self) {
          static_cast<Gate*>(self)->Take(info);
          return GST_PAD_PROBE_OK;
        },
        this, nullptr);
  }
  void Open() {
    const std::lock_guard lock(mutex_);
    closed_from_ = GST_CLOCK_TIME_NONE;
    changed_.notify_all();
  }
  bool AwaitBuffer(GstClockTime pts) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kPatience,
                             [&] { return !shown_.empty() && shown_.back() >= pts; });
  }
  std::vector<GstClockTime> shown() const {
    const std::lock_guard lock(mutex_);
    return shown_;
  }

 private:
  void Take(GstPadProbeInfo* info) {
    std::unique_lock lock(mutex_);
    if ((info->type & GST_PAD_PROBE_TYPE_BUFFER) == 0) {
      if (GST_EVENT_TYPE(info->data) == GST_EVENT_FLUSH_STOP) shown_.clear();
      return;
    }
    const GstClockTime pts = GST_BUFFER_PTS(GST_PAD_PROBE_INFO_BUFFER(info));
    shown_.push_back(pts);
    changed_.notify_all();
    changed_.wait_for(lock, kPatience, [&] { return pts < closed_from_; });
  }

  mutable std::mutex mutex_;  // guards the members below
  std::condition_variable changed_;
  GstClockTime closed_from_;
  std::vector<GstClockTime> shown_;
};

TEST_F(McapSeek, ASeekHoldsWhereItsEndIsPlayedMeanwhile) {
  {
    const Harness h = RecordingTo(Path("a.mcap"));
    const Harness busy(gst_harness_new_with_element(h->element, "sink_1", nullptr));
    const auto slice = [](GstHarness* stream, GstClockTime pts) {
      GstBuffer* buffer = gst_buffer_new_memdup("s", 1);
      GST_BUFFER_PTS(buffer) = pts;
      gst_lidar_buffer_set_capture_time(buffer, kCapture + pts);
      gst_harness_push(stream, buffer);
    };
    for (GstHarness* stream : {h.get(), busy.get()})
      gst_harness_set_src_caps_str(stream, "application/x-lidar-slice,alignment=slice");
    slice(h.get(), 0);
    for (guint i = 0; i < 40; ++i) slice(busy.get(), i * 10 * GST_MSECOND);
    for (GstHarness* stream : {h.get(), busy.get()})
      gst_harness_push_event(stream, gst_event_new_eos());
  }
  Gate gate(100 * GST_MSECOND);
  Pipeline p("mcapsrc name=m" + At("a.mcap") +
             " m.src_0 ! fakesink name=a async=false m.src_1 ! fakesink name=b async=false");
  gate.Guard(p.Find("b").get());
  // The first stream is flushed before the second one. Until its flush has ended, the second stream
  // continues to play.
  const gst::PadPtr first(gst_element_get_static_pad(p.Find("a").get(), "sink"));
  gst_pad_add_probe(
      first.get(), GST_PAD_PROBE_TYPE_EVENT_FLUSH,
      [](GstPad*, GstPadProbeInfo* info, gpointer data) {
        if (GST_EVENT_TYPE(info->data) != GST_EVENT_FLUSH_START) return GST_PAD_PROBE_OK;
        static_cast<Gate*>(data)->Open();
        EXPECT_TRUE(static_cast<Gate*>(data)->AwaitBuffer(300 * GST_MSECOND));
        return GST_PAD_PROBE_OK;
      },
      &gate, nullptr);
  gst_element_set_state(p.get(), GST_STATE_PLAYING);
  ASSERT_TRUE(gate.AwaitBuffer(100 * GST_MSECOND));
  ASSERT_TRUE(gst_element_send_event(
      p.Find("m").get(),
      gst_event_new_seek(1, GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, GST_SEEK_TYPE_NONE, 0,
                         GST_SEEK_TYPE_SET, 200 * gint64{GST_MSECOND})));
  ASSERT_TRUE(p.Wait(GST_MESSAGE_EOS));
  const auto shown = gate.shown();
  ASSERT_EQ(shown.size(), 10U);
  EXPECT_EQ(shown.front(), 100 * GST_MSECOND);
  EXPECT_EQ(shown.back(), 190 * GST_MSECOND);
}

gst::EventPtr NewSeek(GstSeekFlags flags, std::pair<GstSeekType, gint64> start,
                      std::pair<GstSeekType, gint64> stop) {
  return gst::EventPtr(gst_event_new_seek(1, GST_FORMAT_TIME, flags, start.first, start.second,
                                          stop.first, stop.second));
}

/// Returns a segment of ten seconds that was played up to 1 s.
GstSegment PlayedSegment() {
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  segment.duration = 10 * GST_SECOND;
  segment.position = 1 * GST_SECOND;
  return segment;
}

TEST(SeekOfAPlayer, GoesOnFromWhatWasPlayedMeanwhile) {
  GstSegment played = PlayedSegment();
  const std::pair<GstSeekType, gint64> there{GST_SEEK_TYPE_SET, 5 * GST_SECOND};
  const std::pair<GstSeekType, gint64> here{GST_SEEK_TYPE_NONE, 0};
  for (const auto& [start, position] :
       {std::pair<std::pair<GstSeekType, gint64>, GstClockTime>{there, 5 * GST_SECOND},
        {here, 2 * GST_SECOND}}) {
    const auto event =
        NewSeek(GST_SEEK_FLAG_NONE, start, {GST_SEEK_TYPE_SET, 6 * gint64{GST_SECOND}});
    const gst::Seek seek(event.get());
    played.position = GST_SECOND;
    const auto made = seek.AppliedTo(played);
    ASSERT_TRUE(made);
    played.position = 2 * GST_SECOND;
    GstSegment begun = seek.Begun(*made, played);
    EXPECT_EQ(begun.position, position);
    EXPECT_EQ(gst_segment_to_running_time(&begun, GST_FORMAT_TIME, position), 2 * GST_SECOND);
    // The position may also be later than the end of the segment.
    played.position = 7 * GST_SECOND;
    begun = seek.Begun(*made, played);
    EXPECT_EQ(begun.position, start == here ? GstClockTime{6 * GST_SECOND} : position);
    EXPECT_EQ(gst_segment_to_running_time(&begun, GST_FORMAT_TIME, begun.position), 7 * GST_SECOND);
  }
}

TEST(SeekOfAPlayer, CountsFromBothEndsAsGStreamerDoes) {
  const auto position_of = [](GstSeekType type, gint64 start) {
    GstSegment segment = PlayedSegment();
    const auto event = NewSeek(GST_SEEK_FLAG_FLUSH, {type, start}, {GST_SEEK_TYPE_NONE, 0});
    EXPECT_TRUE(gst::ApplySeek(event.get(), &segment)) << type << " " << start;
    return segment.position;
  };
  constexpr gint64 kLargest = std::numeric_limits<gint64>::max();
  EXPECT_EQ(position_of(GST_SEEK_TYPE_SET, -1), 0U);
  EXPECT_EQ(position_of(GST_SEEK_TYPE_END, -gint64{GST_SECOND}), 9 * GST_SECOND);
  EXPECT_EQ(position_of(GST_SEEK_TYPE_END, gint64{GST_SECOND}), 10 * GST_SECOND);
  EXPECT_EQ(position_of(GST_SEEK_TYPE_END, kLargest), 10 * GST_SECOND);
  EXPECT_EQ(position_of(GST_SEEK_TYPE_END, -kLargest), 0U);
}

}  // namespace
}  // namespace lidar::test
