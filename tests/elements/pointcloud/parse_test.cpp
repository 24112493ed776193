// SPDX-License-Identifier: LGPL-2.1-or-later
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "gst/common/buffer_map.h"
#include "tests/elements/pointcloud/parse_fixture.h"
#include "tests/support/patience.h"

namespace lidar::gst {
namespace {

using test::Harness;

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
  const ElementPtr parse(gst_harness_find_element(h_.get(), "pointcloudparse"));
  gint n = 0;
  gint d = 0;
  g_object_get(parse.get(), "framerate", &n, &d, nullptr);
  EXPECT_EQ(n, 20);
  EXPECT_EQ(d, 1);
}

TEST_F(Parse, ANewFrameRateGoesOnWhereTheLastCloudEnded) {
  Start(kKitti);
  const auto running_time = [&] {
    Push(Bytes(160));
    const BufferPtr cloud = Pull();
    const EventPtr event(gst_pad_get_sticky_event(h_->sinkpad, GST_EVENT_SEGMENT, 0));
    const GstSegment* segment = nullptr;
    gst_event_parse_segment(event.get(), &segment);
    return gst_segment_to_running_time(segment, GST_FORMAT_TIME, GST_BUFFER_PTS(cloud.get()));
  };
  for (guint i = 0; i < 3; ++i) EXPECT_EQ(running_time(), i * 100 * GST_MSECOND);
  const CapsPtr caps(gst_caps_from_string(kKitti));
  gst_caps_set_simple(caps.get(), "framerate", GST_TYPE_FRACTION, 20, 1, nullptr);
  gst_pad_push_event(h_->srcpad, gst_event_new_caps(caps.get()));
  for (guint i = 0; i < 3; ++i) EXPECT_EQ(running_time(), (300 + i * 50) * GST_MSECOND);
}

/// If a source sends a segment in time, it receives seeks in time. If it sends a segment in bytes,
/// it receives seeks in bytes.
TEST_F(Parse, ASeekReachesTheSourceInTheFormatThatItSends) {
  for (const GstFormat format : {GST_FORMAT_TIME, GST_FORMAT_BYTES}) {
    Start(std::string(kKitti) + ",width=10");
    PushSegment(format);
    GstFormat sought = GST_FORMAT_UNDEFINED;
    gst_pad_set_element_private(h_->srcpad, &sought);
    gst_pad_set_event_function(h_->srcpad, [](GstPad* pad, GstObject*, GstEvent* raw) -> gboolean {
      const EventPtr event(raw);
      auto* to = static_cast<GstFormat*>(gst_pad_get_element_private(pad));
      if (GST_EVENT_TYPE(raw) == GST_EVENT_SEEK)
        gst_event_parse_seek(raw, nullptr, to, nullptr, nullptr, nullptr, nullptr, nullptr);
      return TRUE;
    });
    BufferPtr cloud = Bytes(160);
    GST_BUFFER_PTS(cloud.get()) = 0;
    ASSERT_EQ(Push(std::move(cloud)), GST_FLOW_OK);
    gst_pad_push_event(
        h_->sinkpad, gst_event_new_seek(1, GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, GST_SEEK_TYPE_SET,
                                        GST_SECOND, GST_SEEK_TYPE_NONE, 0));
    EXPECT_EQ(sought, format);
  }
}

TEST_F(Parse, KeepsTimesThatAreGiven) {
  Start(kKitti);
  PushSegment(GST_FORMAT_TIME);
  BufferPtr buffer = Bytes(160);
  GST_BUFFER_PTS(buffer.get()) = 42;
  Push(std::move(buffer));
  EXPECT_EQ(GST_BUFFER_PTS(Pull().get()), 42U);
}

TEST_F(Parse, ACloudOfSeveralBuffersHasTheTimeOfThatInWhichItBegins) {
  Start(std::string(kKitti) + ",width=10");
  PushSegment(GST_FORMAT_TIME);
  for (const guint64 ms : {0U, 70U, 140U}) {
    BufferPtr piece = Bytes(100);
    GST_BUFFER_PTS(piece.get()) = 5 * GST_SECOND + ms * GST_MSECOND;
    ASSERT_EQ(Push(std::move(piece)), GST_FLOW_OK);
  }
  // This buffer has no timestamp, so its clouds follow at the frame rate.
  ASSERT_EQ(Push(Bytes(340)), GST_FLOW_OK);
  for (const guint ms : {0U, 70U, 140U, 240U})
    EXPECT_EQ(GST_BUFFER_PTS(Pull().get()), 5 * GST_SECOND + ms * GST_MSECOND);
}

TEST_F(Parse, KeepsTheSegmentOfGivenTimesWhereTheFrameRateChanges) {
  Start(kKitti);
  PushSegment(GST_FORMAT_TIME);
  for (const gint rate : {10, 20}) {
    const CapsPtr caps(gst_caps_from_string(kKitti));
    gst_caps_set_simple(caps.get(), "framerate", GST_TYPE_FRACTION, rate, 1, nullptr);
    gst_pad_push_event(h_->srcpad, gst_event_new_caps(caps.get()));
    BufferPtr buffer = Bytes(160);
    GST_BUFFER_PTS(buffer.get()) = 42;
    Push(std::move(buffer));
    EXPECT_EQ(GST_BUFFER_PTS(Pull().get()), 42U);
    const EventPtr event(gst_pad_get_sticky_event(h_->sinkpad, GST_EVENT_SEGMENT, 0));
    const GstSegment* segment = nullptr;
    gst_event_parse_segment(event.get(), &segment);
    EXPECT_EQ(segment->start, 0U) << rate;
    EXPECT_EQ(segment->base, 0U) << rate;
  }
}

TEST_F(Parse, StampsFilesByTheFrameRateOfTheirCaps) {
  const std::string file =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n1 2 3\n";
  Start("application/x-ply,framerate=20/1");
  for (guint i = 0; i < 3; ++i) {
    Push(BufferPtr(gst_buffer_new_memdup(file.data(), file.size())));
    EXPECT_EQ(GST_BUFFER_PTS(Pull().get()), i * 50 * GST_MSECOND);
  }
  const CapsPtr faster(gst_caps_from_string("application/x-ply,framerate=30/1"));
  gst_pad_push_event(h_->srcpad, gst_event_new_caps(faster.get()));
  Push(BufferPtr(gst_buffer_new_memdup(file.data(), file.size())));
  const CapsPtr caps(gst_pad_get_current_caps(h_->sinkpad));
  EXPECT_EQ(CloudInfo::FromCaps(caps.get())->framerate_n, 30);
}

TEST_F(Parse, CutsAStreamOfAnySplitWhereTheCapsGiveTheWidth) {
  Start("application/x-pointcloud2,width=5,height=2,point-step=16,fields=(string)\"x:F32:0\"");
  for (int i = 0; i < 10; ++i) ASSERT_EQ(Push(Bytes(48, static_cast<guint8>(i))), GST_FLOW_OK);
  EXPECT_EQ(gst_harness_buffers_in_queue(h_.get()), 3U);
  const BufferPtr first = Pull();
  const BufferPtr second = Pull();
  EXPECT_EQ(gst_buffer_get_size(first.get()), 160U);
  const BufferMap map(second.get(), GST_MAP_READ);
  EXPECT_EQ(map.data()[0], 3);  // this is byte 160 of the stream
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

TEST_F(Parse, TheFirstCloudOfABufferAfterAGapIsDiscontAndNoOther) {
  Start("application/x-pointcloud2,width=5,height=2,point-step=16,fields=(string)\"x:F32:0\"");
  for (const gsize begin : {100U, 160U, 320U}) {
    BufferPtr after = Bytes(begin);
    GST_BUFFER_FLAG_SET(after.get(), GST_BUFFER_FLAG_DISCONT);
    Push(std::move(after));
    Push(Bytes(480 - begin));
    ASSERT_EQ(gst_harness_buffers_in_queue(h_.get()), 3U);
    for (const bool first : {true, false, false})
      EXPECT_EQ(GST_BUFFER_IS_DISCONT(Pull().get()), first) << begin;
  }
}

TEST_F(Parse, AGapComesBehindCapsAndSegmentOrNotAtAll) {
  Start(kKitti);
  PushSegment(GST_FORMAT_TIME);
  const auto push = [&](BufferPtr cloud) {
    gst_pad_push_event(h_->srcpad, gst_event_new_gap(0, GST_MSECOND));
    if (cloud) Push(std::move(cloud));
    std::string events;
    while (const EventPtr event{gst_harness_try_pull_event(h_.get())})
      events += std::string(GST_EVENT_TYPE_NAME(event.get())) + " ";
    return events;
  };
  EXPECT_EQ(push(Bytes(160)), "stream-start caps segment ");
  EXPECT_EQ(push(nullptr), "gap ");
  PushSegment(GST_FORMAT_TIME);
  EXPECT_EQ(push(nullptr), "segment gap ");
}

TEST_F(Parse, ABufferOfACloudsSizeMayHoldTheEndOfOneAndTheBeginOfTheNext) {
  Start("application/x-pointcloud2,width=5,height=2,point-step=16,fields=(string)\"x:F32:0\"");
  Push(Bytes(100, 1));
  Push(Bytes(160, 2));
  ASSERT_EQ(gst_harness_buffers_in_queue(h_.get()), 1U);
  const BufferPtr cloud = Pull();
  const BufferMap map(cloud.get(), GST_MAP_READ);
  EXPECT_EQ(map.data()[99], 1);
  EXPECT_EQ(map.data()[100], 2);
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
  std::filesystem::resize_file(path, std::uintmax_t{1} << 31);  // the file is sparse
  const gst::ElementPtr pipeline(gst_parse_launch(
      ("filesrc location=" + path + " ! " + kKitti + " ! pointcloudparse ! fakesink").c_str(),
      nullptr));
  gst_element_set_state(pipeline.get(), GST_STATE_PLAYING);
  const test::ElementBus bus(pipeline.get());
  const gst::MessagePtr message = bus.Wait(GST_MESSAGE_ERROR);
  gst_element_set_state(pipeline.get(), GST_STATE_NULL);
  std::remove(path.c_str());
  ASSERT_TRUE(message);
  const std::string text = test::MessageText(message.get());
  EXPECT_NE(text.find("too large for one cloud"), std::string::npos) << text;
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

TEST_F(Parse, AStreamWithoutACloudHasASegmentAllTheSame) {
  Start(kKitti);
  gst_pad_push_event(h_->srcpad, gst_event_new_eos());
  std::vector<std::string> names;
  while (const EventPtr event{gst_harness_try_pull_event(h_.get())})
    names.emplace_back(GST_EVENT_TYPE_NAME(event.get()));
  EXPECT_EQ(names, (std::vector<std::string>{"stream-start", "segment", "eos"}));
}

TEST_F(Parse, ASegmentEndsTheCloudBeforeIt) {
  Start("application/x-pointcloud2,width=5,height=2,point-step=16,fields=(string)\"x:F32:0\"");
  Push(Bytes(100, 1));
  PushSegment(GST_FORMAT_BYTES);
  Push(Bytes(100, 2));
  Push(Bytes(60, 2));
  ASSERT_EQ(gst_harness_buffers_in_queue(h_.get()), 1U);
  const BufferPtr cloud = Pull();
  const BufferMap map(cloud.get(), GST_MAP_READ);
  EXPECT_EQ(map.data()[0], 2);
}

TEST_F(Parse, ACloudWithoutATimeGetsThatOfItsPlace) {
  Start(kKitti);
  PushSegment(GST_FORMAT_TIME);
  for (guint i = 0; i < 3; ++i) {
    Push(Bytes(160));
    EXPECT_EQ(GST_BUFFER_PTS(Pull().get()), i * 100 * GST_MSECOND);
  }
}

TEST_F(Parse, ASliceKeepsItsPlaceInItsScan) {
  Start(kKitti);
  BufferPtr slice = Bytes(160);
  const GstLidarSlice given{7, 1, 4, 128};
  gst_lidar_buffer_set_slice(slice.get(), &given);
  Push(std::move(slice));
  GstLidarSlice meta{};
  ASSERT_TRUE(gst_lidar_buffer_get_slice(Pull().get(), &meta));
  EXPECT_EQ(meta.scan_id, 7U);
  EXPECT_EQ(meta.slice_index, 1U);
  EXPECT_EQ(meta.slice_count, 4U);
  EXPECT_EQ(meta.first_column, 128U);
}

TEST_F(Parse, EachRunHasCaptureTimesOfItsOwn) {
  for (int run = 0; run < 2; ++run) {
    const auto now = static_cast<GstClockTime>(g_get_real_time()) * GST_USECOND;
    Start(kKitti);
    Push(Bytes(160));
    EXPECT_GE(gst_lidar_buffer_get_capture_time(Pull().get()), now);
    gst_element_set_state(h_->element, GST_STATE_NULL);
    gst_element_set_state(h_->element, GST_STATE_PLAYING);
    gst_pad_push_event(h_->srcpad, gst_event_new_stream_start("again"));
    const CapsPtr caps(gst_caps_from_string(kKitti));
    gst_pad_push_event(h_->srcpad, gst_event_new_caps(caps.get()));
    PushSegment(GST_FORMAT_BYTES);
    const auto later = static_cast<GstClockTime>(g_get_real_time()) * GST_USECOND;
    Push(Bytes(160));
    EXPECT_GE(gst_lidar_buffer_get_capture_time(Pull().get()), later);
  }
}

TEST(ParseFile, ASecondFileIsTakenWholeAfterAFirst) {
  const std::string path = ::testing::TempDir() + "again.bin";
  const ElementPtr pipeline(gst_parse_launch(
      ("filesrc location=" + path + " ! " + kKitti + " ! pointcloudparse ! fakesink name=sink")
          .c_str(),
      nullptr));
  const ElementPtr sink(gst_bin_get_by_name(GST_BIN(pipeline.get()), "sink"));
  for (const std::size_t points : {1'000U, 3'000U, 500U}) {
    std::ofstream(path, std::ios::binary) << std::string(16 * points, 'a');
    gst_element_set_state(pipeline.get(), GST_STATE_PLAYING);
    const test::ElementBus bus(pipeline.get());
    const MessagePtr message = bus.Wait(GST_MESSAGE_ERROR | GST_MESSAGE_EOS);
    ASSERT_TRUE(message);
    GstSample* raw = nullptr;
    g_object_get(sink.get(), "last-sample", &raw, nullptr);
    ASSERT_NE(raw, nullptr);
    EXPECT_EQ(gst_buffer_get_size(gst_sample_get_buffer(raw)), 16 * points);
    gst_sample_unref(raw);
    gst_element_set_state(pipeline.get(), GST_STATE_NULL);
  }
  std::remove(path.c_str());
}

}  // namespace
}  // namespace lidar::gst
