// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of seeks and segments of pointcloudparse.
#include <atomic>
#include <cstdio>
#include <fstream>

#include "gst/common/buffer_map.h"
#include "tests/elements/pointcloud/parse_fixture.h"
#include "tests/support/patience.h"

namespace lidar::gst {
namespace {

/// A fixture with a playing source of bytes that supports seeks. The source pushes two more clouds
/// before it performs a seek.
class ParseUnderWay : public Parse {
 protected:
  static constexpr gsize kCloud = 160;

  ParseUnderWay() {
    Start("application/x-pointcloud2,width=5,height=2,point-step=16,fields=(string)\"x:F32:0\"");
    gst_pad_set_element_private(h_->srcpad, this);
    gst_pad_set_event_function(h_->srcpad, Upstream);
  }
  void PushCaps(const std::string& text) {
    const CapsPtr caps(gst_caps_from_string(text.c_str()));
    gst_pad_push_event(h_->srcpad, gst_event_new_caps(caps.get()));
  }
  void PushClouds(int count) {
    for (int i = 0; i < count; ++i) ASSERT_EQ(Push(Bytes(kCloud)), GST_FLOW_OK);
  }
  static gboolean Upstream(GstPad* pad, GstObject*, GstEvent* raw) {
    auto* self = static_cast<ParseUnderWay*>(gst_pad_get_element_private(pad));
    const EventPtr event(raw);
    if (GST_EVENT_TYPE(raw) != GST_EVENT_SEEK) return TRUE;
    self->PushClouds(2);
    gint64 start = 0;
    GstSeekFlags flags = GST_SEEK_FLAG_NONE;
    gst_event_parse_seek(raw, nullptr, nullptr, &flags, nullptr, &start, nullptr, &self->to_);
    self->from_ = static_cast<guint64>(start);
    if (flags & GST_SEEK_FLAG_FLUSH) {
      gst_pad_push_event(pad, gst_event_new_flush_start());
      gst_pad_push_event(pad, gst_event_new_flush_stop(TRUE));
    }
    self->PushBytesFrom(static_cast<guint64>(start), gst_event_get_seqnum(raw));
    return TRUE;
  }
  guint64 from_ = 0;  // start of the last seek event
  gint64 to_ = 0;     // stop of the last seek event
  void PushBytesFrom(guint64 start, guint32 seqnum) {
    GstSegment segment;
    gst_segment_init(&segment, GST_FORMAT_BYTES);
    segment.start = segment.time = segment.position = start;
    GstEvent* event = gst_event_new_segment(&segment);
    gst_event_set_seqnum(event, seqnum);
    gst_pad_push_event(h_->srcpad, event);
  }
  bool Seek(GstSeekFlags flags, gint64 start, GstSeekType type = GST_SEEK_TYPE_SET) {
    return gst_pad_push_event(h_->sinkpad, gst_event_new_seek(1, GST_FORMAT_TIME, flags, type,
                                                              start, GST_SEEK_TYPE_NONE, 0)) !=
           FALSE;
  }
  BufferPtr LastCloud() {
    BufferPtr last;
    while (BufferPtr next{gst_harness_try_pull(h_.get())}) last = std::move(next);
    return last;
  }
  /// Returns the running time of the last cloud that was output.
  GstClockTime RunningTime() {
    const BufferPtr last = LastCloud();
    const EventPtr event(gst_pad_get_sticky_event(h_->sinkpad, GST_EVENT_SEGMENT, 0));
    const GstSegment* segment = nullptr;
    gst_event_parse_segment(event.get(), &segment);
    return gst_segment_to_running_time(segment, GST_FORMAT_TIME, GST_BUFFER_PTS(last.get()));
  }
};

TEST_F(ParseUnderWay, ASeekWithoutAFlushGoesOnWhereTheLastCloudEnded) {
  PushClouds(3);
  ASSERT_TRUE(Seek(GST_SEEK_FLAG_NONE, 2 * gint64{GST_SECOND}));
  PushClouds(1);
  EXPECT_EQ(RunningTime(), 500 * GST_MSECOND);
  ASSERT_TRUE(Seek(GST_SEEK_FLAG_FLUSH, 2 * gint64{GST_SECOND}));
  PushClouds(1);
  EXPECT_EQ(RunningTime(), 0U);
}

TEST_F(ParseUnderWay, ASeekAsksForNoCloudBehindItsStop) {
  PushClouds(1);
  for (const guint64 ms : {401U, 499U, 500U, 501U}) {
    ASSERT_TRUE(gst_pad_push_event(
        h_->sinkpad,
        gst_event_new_seek(1, GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, GST_SEEK_TYPE_SET, 0,
                           GST_SEEK_TYPE_SET, static_cast<gint64>(ms * GST_MSECOND))));
    EXPECT_EQ(static_cast<guint64>(to_) / kCloud, ms > 500 ? 6U : 5U) << ms;
  }
}

TEST_F(ParseUnderWay, WhatASeekCausesHasItsNumber) {
  PushClouds(1);
  const EventPtr seek(gst_event_new_seek(1, GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, GST_SEEK_TYPE_SET,
                                         0, GST_SEEK_TYPE_NONE, 0));
  gst_event_set_seqnum(seek.get(), 4711);
  ASSERT_TRUE(gst_pad_push_event(h_->sinkpad, gst_event_ref(seek.get())));
  PushClouds(1);
  const EventPtr segment(gst_pad_get_sticky_event(h_->sinkpad, GST_EVENT_SEGMENT, 0));
  EXPECT_EQ(gst_event_get_seqnum(segment.get()), 4711U);
  while (const EventPtr event{gst_harness_try_pull_event(h_.get())}) continue;
  GstEvent* done = gst_event_new_segment_done(GST_FORMAT_BYTES, 160);
  gst_event_set_seqnum(done, 4712);
  gst_pad_push_event(h_->srcpad, done);
  guint32 number = 0;
  while (const EventPtr event{gst_harness_try_pull_event(h_.get())})
    if (GST_EVENT_TYPE(event.get()) == GST_EVENT_SEGMENT_DONE)
      number = gst_event_get_seqnum(event.get());
  EXPECT_EQ(number, 4712U);
}

TEST_F(ParseUnderWay, CannotBeSoughtWhereItsSourceCannot) {
  PushClouds(1);
  const QueryPtr query(gst_query_new_seeking(GST_FORMAT_TIME));
  ASSERT_TRUE(gst_pad_peer_query(h_->sinkpad, query.get()));
  gboolean seekable = TRUE;
  gst_query_parse_seeking(query.get(), nullptr, &seekable, nullptr, nullptr);
  EXPECT_FALSE(seekable);
}

TEST_F(ParseUnderWay, ASeekThatItsSourceRefusesFails) {
  PushClouds(3);
  gst_pad_set_event_function(h_->srcpad, [](GstPad*, GstObject*, GstEvent* event) -> gboolean {
    gst_event_unref(event);
    return FALSE;
  });
  EXPECT_FALSE(Seek(GST_SEEK_FLAG_FLUSH, 2 * gint64{GST_SECOND}));
  PushClouds(1);
  EXPECT_EQ(RunningTime(), 300 * GST_MSECOND);
}

TEST_F(ParseUnderWay, ASeekBeyondTheLargestFileFails) {
  PushCaps(
      "application/x-pointcloud2,width=5,height=2,point-step=16,fields=(string)\"x:F32:0\","
      "framerate=2147483647/1");
  PushClouds(1);
  EXPECT_FALSE(Seek(GST_SEEK_FLAG_FLUSH, gint64{1'000'000'000} * gint64{GST_SECOND}));
}

TEST_F(ParseUnderWay, TheEndOfASegmentComesBehindItAndTellsOfWhatIsLeft) {
  const test::ElementBus bus(h_->element);
  Push(Bytes(100));
  gst_pad_push_event(h_->srcpad, gst_event_new_segment_done(GST_FORMAT_BYTES, 100));
  std::vector<GstEventType> types;
  while (const EventPtr event{gst_harness_try_pull_event(h_.get())})
    if (GST_EVENT_TYPE(event.get()) >= GST_EVENT_SEGMENT)
      types.push_back(GST_EVENT_TYPE(event.get()));
  EXPECT_EQ(types, (std::vector<GstEventType>{GST_EVENT_SEGMENT, GST_EVENT_SEGMENT_DONE}));
  EXPECT_EQ(bus.Text(GST_MESSAGE_WARNING),
            "The stream ends within a cloud: 100 bytes are left over.");
}

TEST_F(ParseUnderWay, TheEndOfASegmentInTimeStaysAsItIs) {
  PushSegment(GST_FORMAT_TIME);
  PushClouds(1);
  gst_pad_push_event(h_->srcpad, gst_event_new_segment_done(GST_FORMAT_TIME, 4'711));
  gint64 end = 0;
  while (const EventPtr event{gst_harness_try_pull_event(h_.get())})
    if (GST_EVENT_TYPE(event.get()) == GST_EVENT_SEGMENT_DONE)
      gst_event_parse_segment_done(event.get(), nullptr, &end);
  EXPECT_EQ(end, 4'711);
}

TEST_F(ParseUnderWay, ASeekFromHereRepeatsNoCloud) {
  PushClouds(3);
  ASSERT_TRUE(Seek(GST_SEEK_FLAG_NONE, 0, GST_SEEK_TYPE_NONE));
  EXPECT_EQ(RunningTime(), 400 * GST_MSECOND);
  PushClouds(4);  // the source sends the bytes after the third cloud again
  EXPECT_EQ(gst_harness_buffers_in_queue(h_.get()), 2U);
  EXPECT_EQ(RunningTime(), 600 * GST_MSECOND);
  ASSERT_TRUE(Seek(GST_SEEK_FLAG_FLUSH, 0, GST_SEEK_TYPE_NONE));
  PushClouds(1);
  const BufferPtr last = LastCloud();
  EXPECT_EQ(GST_BUFFER_OFFSET(last.get()), 7U);
  EXPECT_EQ(GST_BUFFER_OFFSET_END(last.get()), 8U);
}

/// The parameter is a frame rate. With some frame rates, the times of clouds are not whole
/// nanoseconds.
class ParseAnyCloud : public ParseUnderWay,
                      public ::testing::WithParamInterface<std::pair<guint64, guint64>> {};
TEST_P(ParseAnyCloud, IsFoundByItsTimeAndKnowsItsOffset) {
  const auto [n, d] = GetParam();
  PushCaps(
      "application/x-pointcloud2,width=5,height=2,point-step=16,fields=(string)\"x:F32:0\","
      "framerate=" +
      std::to_string(n) + "/" + std::to_string(d));
  PushClouds(1);  // from now on the element knows the size of a cloud
  const auto time_of = [n = n, d = d](guint64 cloud) {
    return gst_util_uint64_scale(cloud, d * GST_SECOND, n);
  };
  for (const guint64 cloud : {1U, 2U, 3U, 7U, 29U, 100U, 1'001U, 9'999U}) {
    for (const gint64 off : {-1, 0, 1}) {
      const auto time = static_cast<gint64>(time_of(cloud)) + off;
      ASSERT_TRUE(
          Seek(static_cast<GstSeekFlags>(GST_SEEK_FLAG_FLUSH | GST_SEEK_FLAG_KEY_UNIT), time));
      LastCloud();
      PushClouds(1);
      const BufferPtr last = LastCloud();
      const guint64 expected = off < 0 ? cloud - 1 : cloud;
      EXPECT_EQ(from_ / kCloud, expected) << "cloud " << cloud << (off < 0 ? ", before" : "");
      EXPECT_EQ(GST_BUFFER_OFFSET(last.get()), expected);
      EXPECT_EQ(GST_BUFFER_OFFSET_END(last.get()), expected + 1);
      EXPECT_EQ(GST_BUFFER_PTS(last.get()), time_of(expected));
      EXPECT_EQ(GST_BUFFER_DURATION(last.get()), time_of(expected + 1) - time_of(expected));
      const EventPtr event(gst_pad_get_sticky_event(h_->sinkpad, GST_EVENT_SEGMENT, 0));
      const GstSegment* segment = nullptr;
      gst_event_parse_segment(event.get(), &segment);
      EXPECT_EQ(segment->start, time_of(expected)) << "the cloud is the key unit";
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Rates, ParseAnyCloud,
                         ::testing::Values(std::pair<guint64, guint64>(10, 1),
                                           std::pair<guint64, guint64>(30, 1),
                                           std::pair<guint64, guint64>(30'000, 1'001),
                                           std::pair<guint64, guint64>(7, 3)));

TEST_F(ParseUnderWay, BytesFromElsewhereGoOnWhereTheLastCloudEnded) {
  PushClouds(3);
  PushBytesFrom(7 * kCloud, 4711);
  PushClouds(1);
  EXPECT_EQ(RunningTime(), 300 * GST_MSECOND);
  gst_pad_push_event(h_->srcpad, gst_event_new_flush_start());
  gst_pad_push_event(h_->srcpad, gst_event_new_flush_stop(FALSE));
  PushBytesFrom(0, 4712);
  PushClouds(1);
  EXPECT_EQ(RunningTime(), 400 * GST_MSECOND);
}

TEST_F(ParseUnderWay, BuffersThatAreCloudsGoOnWhereTheLastCloudEnded) {
  Start(kKitti);
  PushClouds(3);
  PushBytesFrom(0, 4711);
  PushClouds(1);
  EXPECT_EQ(RunningTime(), 300 * GST_MSECOND);
  PushClouds(2);
  EXPECT_EQ(RunningTime(), 500 * GST_MSECOND);
  // At another frame rate, the cloud with the same number has another time.
  PushCaps("application/x-pointcloud2,point-step=16,fields=(string)\"x:F32:0\",framerate=20/1");
  PushBytesFrom(0, 4712);
  PushClouds(2);
  EXPECT_EQ(RunningTime(), 650 * GST_MSECOND);
}

/// A paused pipeline with a file of ten clouds at 10 Hz. Each cloud has 8 points, which contain the
/// number of the cloud.
class ParseSeek : public ::testing::Test {
 protected:
  explicit ParseSeek(const std::string& behind = "") {
    std::ofstream file(path_, std::ios::binary);
    for (char i = 0; i < 10; ++i) file << std::string(8 * 16, i);
    file.close();
    const std::string line = "filesrc location=" + path_ + " ! " + kKitti +
                             ",width=8 ! pointcloudparse ! " + behind +
                             "fakesink name=sink sync=false "
                             "signal-handoffs=true";
    pipeline_.reset(gst_parse_launch(line.c_str(), nullptr));
    const ElementPtr sink(gst_bin_get_by_name(GST_BIN(pipeline_.get()), "sink"));
    g_signal_connect(sink.get(), "handoff",
                     G_CALLBACK(+[](GstElement*, GstBuffer* buffer, GstPad*, gpointer data) {
                       const BufferMap map(buffer, GST_MAP_READ);
                       auto* self = static_cast<ParseSeek*>(data);
                       self->clouds_.push_back(map.data()[0]);
                       self->times_.push_back(GST_BUFFER_PTS(buffer));
                     }),
                     this);
    const PadPtr pad(gst_element_get_static_pad(sink.get(), "sink"));
    gst_pad_add_probe(
        pad.get(), GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM,
        [](GstPad*, GstPadProbeInfo* info, gpointer data) {
          if (GST_EVENT_TYPE(info->data) == GST_EVENT_SEGMENT_DONE) {
            gint64 end = -1;
            gst_event_parse_segment_done(GST_EVENT(info->data), nullptr, &end);
            static_cast<ParseSeek*>(data)->end_of_segment_ = end;
          }
          return GST_PAD_PROBE_OK;
        },
        this, nullptr);
    gst_element_set_state(pipeline_.get(), GST_STATE_PAUSED);
    gst_element_get_state(pipeline_.get(), nullptr, nullptr, GST_CLOCK_TIME_NONE);
  }
  ~ParseSeek() override {
    gst_element_set_state(pipeline_.get(), GST_STATE_NULL);
    std::remove(path_.c_str());
  }
  bool Seek(gint flags, GstClockTime start, gint64 stop = -1, gdouble rate = 1) {
    return gst_element_seek(pipeline_.get(), rate, GST_FORMAT_TIME,
                            static_cast<GstSeekFlags>(flags), GST_SEEK_TYPE_SET,
                            static_cast<gint64>(start), GST_SEEK_TYPE_SET, stop) != FALSE;
  }
  /// Plays until a message of this type. Returns the numbers of the clouds that were played.
  std::vector<int> PlayTo(GstMessageType type) {
    clouds_.clear();
    times_.clear();
    gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING);
    const test::ElementBus bus(pipeline_.get());
    const MessagePtr message = bus.Wait(type | GST_MESSAGE_ERROR);
    EXPECT_TRUE(message && GST_MESSAGE_TYPE(message.get()) == type);
    gst_element_set_state(pipeline_.get(), GST_STATE_PAUSED);
    return clouds_;
  }

  /// Waits for the event that ends the segment, because the source posts its message before it
  /// pushes the event.
  gint64 AwaitEndOfSegment() const {
    test::Eventually([&] { return end_of_segment_ >= 0; });
    return end_of_segment_;
  }

  /// Returns the running time at the start of the current segment.
  GstClockTime Base() {
    const ElementPtr sink(gst_bin_get_by_name(GST_BIN(pipeline_.get()), "sink"));
    const PadPtr pad(gst_element_get_static_pad(sink.get(), "sink"));
    const EventPtr event(gst_pad_get_sticky_event(pad.get(), GST_EVENT_SEGMENT, 0));
    const GstSegment* segment = nullptr;
    gst_event_parse_segment(event.get(), &segment);
    return segment->base;
  }

  const std::string path_ = ::testing::TempDir() + "seek.bin";
  ElementPtr pipeline_;
  std::vector<int> clouds_;
  std::vector<GstClockTime> times_;
  std::atomic<gint64> end_of_segment_{-1};
};

TEST_F(ParseSeek, KnowsHowLongTheFileIsAndThatItCanBeSought) {
  gint64 duration = 0;
  ASSERT_TRUE(gst_element_query_duration(pipeline_.get(), GST_FORMAT_TIME, &duration));
  EXPECT_EQ(duration, gint64{GST_SECOND});
  gint64 bytes = 10 * 8 * 16;
  gst_element_query_duration(pipeline_.get(), GST_FORMAT_BYTES, &bytes);
  EXPECT_EQ(bytes, 10 * 8 * 16);
  const QueryPtr query(gst_query_new_seeking(GST_FORMAT_TIME));
  ASSERT_TRUE(gst_element_query(pipeline_.get(), query.get()));
  gboolean seekable = FALSE;
  gint64 end = 0;
  gst_query_parse_seeking(query.get(), nullptr, &seekable, nullptr, &end);
  EXPECT_TRUE(seekable);
  EXPECT_EQ(end, gint64{GST_SECOND});
}

TEST_F(ParseSeek, BeginsWithTheCloudOfTheTimeAndEndsWithThatOfTheStop) {
  ASSERT_TRUE(Seek(GST_SEEK_FLAG_FLUSH | GST_SEEK_FLAG_ACCURATE, 300 * GST_MSECOND));
  EXPECT_EQ(PlayTo(GST_MESSAGE_EOS), (std::vector<int>{3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(times_.front(), 300 * GST_MSECOND);
  ASSERT_TRUE(
      Seek(GST_SEEK_FLAG_FLUSH | GST_SEEK_FLAG_KEY_UNIT, 250 * GST_MSECOND, 500 * GST_MSECOND));
  EXPECT_EQ(PlayTo(GST_MESSAGE_EOS), (std::vector<int>{2, 3, 4}));
}

TEST_F(ParseSeek, ASegmentSeekEndsWithItsMessageAndGoesOnFromThere) {
  ASSERT_TRUE(Seek(GST_SEEK_FLAG_FLUSH | GST_SEEK_FLAG_SEGMENT, 0, 200 * GST_MSECOND));
  EXPECT_EQ(PlayTo(GST_MESSAGE_SEGMENT_DONE), (std::vector<int>{0, 1}));
  ASSERT_TRUE(Seek(GST_SEEK_FLAG_SEGMENT, 800 * GST_MSECOND));
  EXPECT_EQ(PlayTo(GST_MESSAGE_SEGMENT_DONE), (std::vector<int>{8, 9}));
}

TEST_F(ParseSeek, ASegmentEndsNoLaterThanItsStop) {
  ASSERT_TRUE(Seek(GST_SEEK_FLAG_FLUSH | GST_SEEK_FLAG_SEGMENT, 0, 250 * GST_MSECOND));
  EXPECT_EQ(PlayTo(GST_MESSAGE_SEGMENT_DONE), (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(AwaitEndOfSegment(), gint64{250 * GST_MSECOND});
  // The next segment begins at the running time at which this segment ended.
  ASSERT_TRUE(Seek(GST_SEEK_FLAG_SEGMENT, 800 * GST_MSECOND));
  EXPECT_EQ(PlayTo(GST_MESSAGE_SEGMENT_DONE), (std::vector<int>{8, 9}));
  EXPECT_EQ(Base(), 250 * GST_MSECOND);
}

TEST_F(ParseSeek, CountsFromTheEndWhereItIsAsked) {
  ASSERT_TRUE(gst_element_seek(pipeline_.get(), 1, GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH,
                               GST_SEEK_TYPE_END, -200 * gint64{GST_MSECOND}, GST_SEEK_TYPE_NONE,
                               0));
  EXPECT_EQ(PlayTo(GST_MESSAGE_EOS), (std::vector<int>{8, 9}));
}

TEST_F(ParseSeek, RefusesToPlayBackwardsAndToEndBeforeItBegins) {
  EXPECT_FALSE(Seek(GST_SEEK_FLAG_FLUSH, 800 * GST_MSECOND, 200 * GST_MSECOND));
  EXPECT_FALSE(Seek(GST_SEEK_FLAG_FLUSH, 0, gint64{GST_SECOND}, -1));
  EXPECT_EQ(PlayTo(GST_MESSAGE_EOS).size(), 10U);
}

class SeekThroughMerge : public ParseSeek {
 protected:
  SeekThroughMerge() : ParseSeek("pointcloudmerge ! ") {}
};

TEST_F(SeekThroughMerge, GivesTheCloudsOfItsSegment) {
  ASSERT_TRUE(Seek(GST_SEEK_FLAG_FLUSH | GST_SEEK_FLAG_ACCURATE, 300 * GST_MSECOND));
  EXPECT_EQ(PlayTo(GST_MESSAGE_EOS), (std::vector<int>{3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(times_.front(), 300 * GST_MSECOND);
}

}  // namespace
}  // namespace lidar::gst
