// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "gst/common/buffer_map.h"
#include "gst/common/cloud_info.h"
#include "tests/support/harness.h"

namespace lidar::gst {
namespace {

using test::Harness;

const char* const kKitti =
    "application/x-pointcloud2,height=1,point-step=16,"
    "fields=(string)\"x:F32:0,y:F32:4,z:F32:8,intensity:F32:12\",framerate=10/1";

BufferPtr Bytes(gsize size, guint8 value = 7) {
  BufferPtr buffer(gst_buffer_new_allocate(nullptr, size, nullptr));
  gst_buffer_memset(buffer.get(), 0, value, size);
  return buffer;
}

class Parse : public ::testing::Test {
 protected:
  /// A source of bytes, as files are.
  void Start(const std::string& caps, const char* element = "pointcloudparse") {
    h_.reset(gst_harness_new_parse(element));
    gst_harness_play(h_.get());
    gst_pad_push_event(h_->srcpad, gst_event_new_stream_start("test"));
    const CapsPtr parsed(gst_caps_from_string(caps.c_str()));
    gst_pad_push_event(h_->srcpad, gst_event_new_caps(parsed.get()));
    PushSegment(GST_FORMAT_BYTES);
  }
  void PushSegment(GstFormat format) {
    GstSegment segment;
    gst_segment_init(&segment, format);
    gst_pad_push_event(h_->srcpad, gst_event_new_segment(&segment));
  }
  GstFlowReturn Push(BufferPtr buffer) { return gst_pad_push(h_->srcpad, buffer.release()); }
  BufferPtr Pull() { return BufferPtr(gst_harness_pull(h_.get())); }
  guint Width() {
    const CapsPtr caps(gst_pad_get_current_caps(h_->sinkpad));
    return CloudInfo::FromCaps(caps.get())->width;
  }
  std::string ErrorText(GstMessageType type) {
    GstBus* bus = gst_element_get_bus(h_->element);
    const MessagePtr message(bus == nullptr ? nullptr : gst_bus_pop_filtered(bus, type));
    if (bus != nullptr) gst_object_unref(bus);
    if (!message) return "";
    GError* raw = nullptr;
    if (type == GST_MESSAGE_ERROR)
      gst_message_parse_error(message.get(), &raw, nullptr);
    else
      gst_message_parse_warning(message.get(), &raw, nullptr);
    const ErrorPtr error(raw);
    return error->message;
  }
  void WatchMessages() {
    GstBus* bus = gst_bus_new();
    gst_element_set_bus(h_->element, bus);
    gst_object_unref(bus);
  }

  Harness h_;
};

TEST_F(Parse, TakesTheWidthFromTheSizeOfEachFile) {
  Start(kKitti);
  ASSERT_EQ(Push(Bytes(16 * 100)), GST_FLOW_OK);
  EXPECT_EQ(gst_buffer_get_size(Pull().get()), 1600U);
  EXPECT_EQ(Width(), 100U);
  ASSERT_EQ(Push(Bytes(16 * 90)), GST_FLOW_OK);
  Pull();
  EXPECT_EQ(Width(), 90U);
}

TEST_F(Parse, StampsByTheFrameRateOfTheCapsInATimeSegment) {
  Start(kKitti);
  for (guint i = 0; i < 3; ++i) {
    Push(Bytes(160));
    const BufferPtr cloud = Pull();
    EXPECT_EQ(GST_BUFFER_PTS(cloud.get()), i * 100 * GST_MSECOND);
    EXPECT_EQ(GST_BUFFER_DURATION(cloud.get()), 100 * GST_MSECOND);
  }
  const EventPtr event(gst_pad_get_sticky_event(h_->sinkpad, GST_EVENT_SEGMENT, 0));
  ASSERT_TRUE(event);
  const GstSegment* segment = nullptr;
  gst_event_parse_segment(event.get(), &segment);
  EXPECT_EQ(segment->format, GST_FORMAT_TIME);
}

TEST_F(Parse, ThePropertyGoesBeforeTheFrameRateOfTheCaps) {
  Start(kKitti, "pointcloudparse framerate=20/1");
  Push(Bytes(160));
  Pull();
  Push(Bytes(160));
  EXPECT_EQ(GST_BUFFER_PTS(Pull().get()), 50 * GST_MSECOND);
  const CapsPtr caps(gst_pad_get_current_caps(h_->sinkpad));
  EXPECT_EQ(CloudInfo::FromCaps(caps.get())->framerate_n, 20);
}

TEST_F(Parse, KeepsTimesThatAreGiven) {
  Start(kKitti);
  PushSegment(GST_FORMAT_TIME);
  BufferPtr buffer = Bytes(160);
  GST_BUFFER_PTS(buffer.get()) = 42;
  Push(std::move(buffer));
  EXPECT_EQ(GST_BUFFER_PTS(Pull().get()), 42U);
}

TEST_F(Parse, CutsAStreamOfAnySplitWhereTheCapsGiveTheWidth) {
  Start("application/x-pointcloud2,width=5,height=2,point-step=16,fields=(string)\"x:F32:0\"");
  for (int i = 0; i < 10; ++i) ASSERT_EQ(Push(Bytes(48, static_cast<guint8>(i))), GST_FLOW_OK);
  EXPECT_EQ(gst_harness_buffers_in_queue(h_.get()), 3U);
  const BufferPtr first = Pull();
  const BufferPtr second = Pull();
  EXPECT_EQ(gst_buffer_get_size(first.get()), 160U);
  const BufferMap map(second.get(), GST_MAP_READ);
  EXPECT_EQ(map.data()[0], 3);  // byte 160 of the stream
}

TEST_F(Parse, WarnsOfWhatIsLeftOverAtTheEnd) {
  Start("application/x-pointcloud2,width=5,height=2,point-step=16,fields=(string)\"x:F32:0\"");
  WatchMessages();
  Push(Bytes(150));
  gst_pad_push_event(h_->srcpad, gst_event_new_eos());
  EXPECT_NE(ErrorText(GST_MESSAGE_WARNING).find("150 bytes are left over"), std::string::npos);
  EXPECT_EQ(gst_harness_buffers_in_queue(h_.get()), 0U);
}

TEST_F(Parse, ForgetsTheStartOfACloudOnFlush) {
  Start("application/x-pointcloud2,width=5,height=2,point-step=16,fields=(string)\"x:F32:0\"");
  Push(Bytes(100, 1));
  gst_pad_push_event(h_->srcpad, gst_event_new_flush_start());
  gst_pad_push_event(h_->srcpad, gst_event_new_flush_stop(TRUE));
  PushSegment(GST_FORMAT_BYTES);
  Push(Bytes(100, 2));
  EXPECT_EQ(gst_harness_buffers_in_queue(h_.get()), 0U);
  Push(Bytes(60, 2));
  const BufferPtr cloud = Pull();
  const BufferMap map(cloud.get(), GST_MAP_READ);
  EXPECT_EQ(map.data()[0], 2);
  EXPECT_EQ(GST_BUFFER_PTS(cloud.get()), 0U);
}

TEST_F(Parse, SaysWhenAFileIsNotMadeOfPoints) {
  Start(kKitti);
  WatchMessages();
  EXPECT_EQ(Push(Bytes(1601)), GST_FLOW_ERROR);
  EXPECT_NE(ErrorText(GST_MESSAGE_ERROR).find("1601 bytes"), std::string::npos);
}

TEST_F(Parse, LeavesAnEmptyCloudOutAndKeepsTheTimesOfTheOthers) {
  Start(kKitti);
  WatchMessages();
  EXPECT_EQ(Push(Bytes(160)), GST_FLOW_OK);
  EXPECT_EQ(Push(Bytes(0)), GST_FLOW_OK);
  EXPECT_EQ(Push(Bytes(0)), GST_FLOW_OK);
  EXPECT_EQ(Push(Bytes(160)), GST_FLOW_OK);
  EXPECT_EQ(Push(Bytes(160)), GST_FLOW_OK);
  EXPECT_EQ(gst_harness_buffers_in_queue(h_.get()), 3U);
  EXPECT_EQ(GST_BUFFER_PTS(Pull().get()), 0U);
  const BufferPtr after = Pull();
  EXPECT_EQ(GST_BUFFER_PTS(after.get()), 300 * GST_MSECOND);
  EXPECT_TRUE(GST_BUFFER_IS_DISCONT(after.get()));
  EXPECT_FALSE(GST_BUFFER_IS_DISCONT(Pull().get()));
  EXPECT_NE(ErrorText(GST_MESSAGE_WARNING).find("A cloud is empty"), std::string::npos);
  EXPECT_EQ(ErrorText(GST_MESSAGE_WARNING), "");
}

TEST_F(Parse, ABufferAfterAGapDoesNotFinishTheCloudBeforeIt) {
  Start("application/x-pointcloud2,width=5,height=2,point-step=16,fields=(string)\"x:F32:0\"");
  Push(Bytes(100, 1));
  BufferPtr after = Bytes(160, 2);
  GST_BUFFER_FLAG_SET(after.get(), GST_BUFFER_FLAG_DISCONT);
  Push(std::move(after));
  ASSERT_EQ(gst_harness_buffers_in_queue(h_.get()), 1U);
  const BufferPtr cloud = Pull();
  const BufferMap map(cloud.get(), GST_MAP_READ);
  EXPECT_EQ(map.data()[0], 2);
}

TEST_F(Parse, StartsAfreshAfterAStateCycle) {
  Start(kKitti);
  for (int cycle = 0; cycle < 3; ++cycle) {
    Push(Bytes(160));
    EXPECT_EQ(GST_BUFFER_PTS(Pull().get()), 0U);
    gst_element_set_state(h_->element, GST_STATE_NULL);
    gst_harness_play(h_.get());
    gst_pad_push_event(h_->srcpad, gst_event_new_stream_start("again"));
    const CapsPtr caps(gst_caps_from_string(kKitti));
    gst_pad_push_event(h_->srcpad, gst_event_new_caps(caps.get()));
    PushSegment(GST_FORMAT_BYTES);
  }
}

TEST(ParseFile, AFileWithoutAWidthIsOneCloud) {
  const std::string path = ::testing::TempDir() + "one.bin";
  std::ofstream(path, std::ios::binary) << std::string(16 * 3000, 'a');
  const Harness h(gst_harness_new_parse(
      ("filesrc location=" + path + " ! " + kKitti + " ! pointcloudparse").c_str()));
  gst_harness_play(h.get());
  const BufferPtr cloud(gst_harness_pull(h.get()));
  EXPECT_EQ(gst_buffer_get_size(cloud.get()), 48'000U);
  std::remove(path.c_str());
}

TEST(ParseFile, AFileThatIsTooLargeForOneCloudIsAnErrorAtOnce) {
  const std::string path = ::testing::TempDir() + "large.bin";
  std::ofstream(path, std::ios::binary) << "a";
  std::filesystem::resize_file(path, std::uintmax_t{1} << 31);  // sparse
  const gst::ElementPtr pipeline(gst_parse_launch(
      ("filesrc location=" + path + " ! " + kKitti + " ! pointcloudparse ! fakesink").c_str(),
      nullptr));
  gst_element_set_state(pipeline.get(), GST_STATE_PLAYING);
  GstBus* bus = gst_element_get_bus(pipeline.get());
  const gst::MessagePtr message(
      gst_bus_timed_pop_filtered(bus, 20 * GST_SECOND, GST_MESSAGE_ERROR));
  gst_object_unref(bus);
  gst_element_set_state(pipeline.get(), GST_STATE_NULL);
  std::remove(path.c_str());
  ASSERT_TRUE(message);
  GError* raw = nullptr;
  gst_message_parse_error(message.get(), &raw, nullptr);
  const gst::ErrorPtr error(raw);
  EXPECT_NE(std::string(error->message).find("too large for one cloud"), std::string::npos)
      << error->message;
}

/// A source of bytes that can seek and is under way: two clouds come while it is told to.
class ParseUnderWay : public Parse {
 protected:
  static constexpr gsize kCloud = 160;

  ParseUnderWay() {
    Start("application/x-pointcloud2,width=5,height=2,point-step=16,fields=(string)\"x:F32:0\"");
    gst_pad_set_element_private(h_->srcpad, this);
    gst_pad_set_event_function(h_->srcpad, Upstream);
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
    gst_event_parse_seek(raw, nullptr, nullptr, &flags, nullptr, &start, nullptr, nullptr);
    if (flags & GST_SEEK_FLAG_FLUSH) {
      gst_pad_push_event(pad, gst_event_new_flush_start());
      gst_pad_push_event(pad, gst_event_new_flush_stop(TRUE));
    }
    self->PushBytesFrom(static_cast<guint64>(start), gst_event_get_seqnum(raw));
    return TRUE;
  }
  void PushBytesFrom(guint64 start, guint32 seqnum) {
    GstSegment segment;
    gst_segment_init(&segment, GST_FORMAT_BYTES);
    segment.start = segment.time = segment.position = start;
    GstEvent* event = gst_event_new_segment(&segment);
    gst_event_set_seqnum(event, seqnum);
    gst_pad_push_event(h_->srcpad, event);
  }
  bool Seek(GstSeekFlags flags, gint64 start) {
    return gst_pad_push_event(
               h_->sinkpad, gst_event_new_seek(1, GST_FORMAT_TIME, flags, GST_SEEK_TYPE_SET, start,
                                               GST_SEEK_TYPE_NONE, 0)) != FALSE;
  }
  /// When the last cloud that came is shown.
  GstClockTime RunningTime() {
    BufferPtr last;
    while (BufferPtr next{gst_harness_try_pull(h_.get())}) last = std::move(next);
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

/// A file of ten clouds at 10 Hz, each of 8 points that hold its number, in PAUSED.
class ParseSeek : public ::testing::Test {
 protected:
  ParseSeek() {
    std::ofstream file(path_, std::ios::binary);
    for (char i = 0; i < 10; ++i) file << std::string(8 * 16, i);
    file.close();
    const std::string line = "filesrc location=" + path_ + " ! " + kKitti +
                             ",width=8 ! pointcloudparse ! fakesink name=sink sync=false "
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
          if (GST_EVENT_TYPE(info->data) == GST_EVENT_SEGMENT_DONE)
            gst_event_parse_segment_done(GST_EVENT(info->data), nullptr,
                                         &static_cast<ParseSeek*>(data)->end_of_segment_);
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
  /// The clouds from now to the message.
  std::vector<int> PlayTo(GstMessageType type) {
    clouds_.clear();
    times_.clear();
    gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING);
    GstBus* bus = gst_element_get_bus(pipeline_.get());
    const MessagePtr message(gst_bus_timed_pop_filtered(
        bus, 30 * GST_SECOND, static_cast<GstMessageType>(type | GST_MESSAGE_ERROR)));
    gst_object_unref(bus);
    EXPECT_TRUE(message && GST_MESSAGE_TYPE(message.get()) == type);
    gst_element_set_state(pipeline_.get(), GST_STATE_PAUSED);
    return clouds_;
  }

  /// Running time at which the segment of now begins.
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
  gint64 end_of_segment_ = -1;
};

TEST_F(ParseSeek, KnowsHowLongTheFileIsAndThatItCanBeSought) {
  gint64 duration = 0;
  ASSERT_TRUE(gst_element_query_duration(pipeline_.get(), GST_FORMAT_TIME, &duration));
  EXPECT_EQ(duration, gint64{GST_SECOND});
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
  EXPECT_EQ(end_of_segment_, gint64{250 * GST_MSECOND});
  // What follows goes on where the segment ended, for a clock.
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

TEST(ParseFile, EachFileOfASeriesIsACloud) {
  const std::string folder = ::testing::TempDir();
  for (int i = 0; i < 3; ++i)
    std::ofstream(folder + "series" + std::to_string(i) + ".bin", std::ios::binary)
        << std::string(static_cast<std::size_t>(16 * (300 + i)), 'a');
  const Harness h(gst_harness_new_parse(
      ("multifilesrc location=" + folder + "series%d.bin ! pointcloudparse").c_str()));
  GstElement* source = gst_harness_find_element(h.get(), "multifilesrc");
  const CapsPtr caps(gst_caps_from_string(kKitti));
  g_object_set(source, "caps", caps.get(), nullptr);
  gst_object_unref(source);
  gst_harness_play(h.get());
  for (guint i = 0; i < 3; ++i) {
    const BufferPtr cloud(gst_harness_pull(h.get()));
    EXPECT_EQ(gst_buffer_get_size(cloud.get()), 16U * (300 + i));
    EXPECT_EQ(GST_BUFFER_PTS(cloud.get()), i * 100 * GST_MSECOND);
    std::remove((folder + "series" + std::to_string(i) + ".bin").c_str());
  }
}

}  // namespace
}  // namespace lidar::gst
