// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of the content of a recording, message by message.

#include "ext/mcap/timeline.h"
#include "src/cdr/coded_slice.h"
#include "src/cdr/messages.h"
#include "src/cdr/point_cloud2.h"
#include "tests/core/mcap/memory_file.h"
#include "tests/elements/mcap/recording.h"

namespace lidar::test {
namespace {

constexpr const char* kSlices = "application/x-lidar-slice,alignment=slice";
constexpr const char* kImu =
    "application/x-imu,sample-size=32,"
    "fields=(string)\"t:U64:0,ax:F32:8,ay:F32:12,az:F32:16,gx:F32:20,gy:F32:24,gz:F32:28\"";

struct Logged {
  std::string topic;
  mcap::MessageHeader header;
  std::vector<std::uint8_t> data;
};

std::vector<Logged> MessagesOf(const std::string& path) {
  const std::string bytes = ReadFile(path);
  const auto reader = mcap::test::Open({bytes.begin(), bytes.end()});
  std::vector<Logged> all;
  while (const auto message = reader ? reader->Next() : std::nullopt)
    all.push_back({reader->index().channels.at(message->header.channel_id).topic,
                   message->header,
                   {message->data.begin(), message->data.end()}});
  return all;
}

ByteView ViewOf(const Logged& message) { return {message.data.data(), message.data.size()}; }

GstClockTime StampOf(const cdr::Header& header) {
  return static_cast<GstClockTime>(header.stamp.time_since_epoch().count());
}

GstBuffer* Slice(guint8 byte, GstClockTime pts, GstClockTime captured) {
  GstBuffer* buffer = gst_buffer_new_memdup(&byte, 1);
  GST_BUFFER_PTS(buffer) = pts;
  if (captured != GST_CLOCK_TIME_NONE) gst_lidar_buffer_set_capture_time(buffer, captured);
  return buffer;
}

void Begin(GstHarness* h, const char* caps) {
  gst_harness_push_event(h, gst_event_new_stream_start("again"));
  gst_harness_set_src_caps_str(h, caps);
}

void End(GstHarness* h) { gst_harness_push_event(h, gst_event_new_eos()); }

class McapContent : public Recording {
 protected:
  /// Records `buffers` with `caps`, in the frame `sensor_frame_`. Returns the recorded messages.
  std::vector<Logged> Write(const char* caps, const std::vector<GstBuffer*>& buffers) {
    const Harness h = RecordingTo(Path("a.mcap"));
    gst_child_proxy_set(GST_CHILD_PROXY(h->element), "sink_0::frame-id", sensor_frame_, nullptr);
    gst_harness_set_src_caps_str(h.get(), caps);
    SetPlaying(h.get());
    for (GstBuffer* buffer : buffers) EXPECT_EQ(gst_harness_push(h.get(), buffer), GST_FLOW_OK);
    End(h.get());
    return MessagesOf(Path("a.mcap"));
  }
  std::vector<Logged> WriteZeros(const std::string& caps, gsize size) {
    GstBuffer* zeros = gst_buffer_new_allocate(nullptr, size, nullptr);
    gst_buffer_memset(zeros, 0, 0, size);
    GST_BUFFER_PTS(zeros) = 0;
    gst_lidar_buffer_set_capture_time(zeros, kCapture);
    return Write(caps.c_str(), {zeros});
  }

  const char* sensor_frame_ = "front";
};

TEST_F(McapContent, SlicesHaveRunningTimesAsLogTimesAndCaptureTimesAsTheirOwn) {
  GstBuffer* second = Slice(2, 10 * GST_MSECOND, kCapture + 12 * GST_MSECOND);
  GST_BUFFER_DURATION(second) = 5 * GST_MSECOND;
  const auto messages = Write(
      kSlices, {Slice(1, 0, kCapture), second, Slice(3, 20 * GST_MSECOND, GST_CLOCK_TIME_NONE)});
  ASSERT_EQ(messages.size(), 3U);
  const GstClockTime stamps[] = {kCapture, kCapture + 12 * GST_MSECOND, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(messages[i].topic, "/slices");
    EXPECT_EQ(messages[i].header.log_time, kCapture + i * 10 * GST_MSECOND);
    EXPECT_EQ(messages[i].header.sequence, i);
    const auto slice = cdr::ReadCodedSlice(ViewOf(messages[i]));
    ASSERT_TRUE(slice);
    EXPECT_EQ(slice->header.frame_id, "front");
    EXPECT_EQ(StampOf(slice->header), stamps[i]);
    EXPECT_EQ(slice->duration.has_value(), i == 1);
  }
  EXPECT_EQ(messages[1].header.publish_time, stamps[1]);
  EXPECT_EQ(messages[2].header.publish_time, messages[2].header.log_time);
}

TEST_F(McapContent, AStreamThatTakesTurnsBetweenItsCapsHasAChannelForEach) {
  const Harness h = RecordingTo(Path("a.mcap"));
  const std::string other = std::string(kSlices) + ", framerate=(fraction)20/1";
  SetPlaying(h.get());
  for (guint8 i = 0; i < 100; ++i) {
    gst_harness_set_src_caps_str(h.get(), i % 2 == 0 ? kSlices : other.c_str());
    EXPECT_EQ(gst_harness_push(h.get(), Slice(i, i, kCapture)), GST_FLOW_OK);
  }
  End(h.get());
  const std::string bytes = ReadFile(Path("a.mcap"));
  const auto reader = mcap::test::Open({bytes.begin(), bytes.end()});
  ASSERT_TRUE(reader);
  EXPECT_EQ(reader->index().channels.size(), 2U);
  std::map<std::uint16_t, int> messages;
  while (const auto message = reader->Next()) ++messages[message->header.channel_id];
  EXPECT_EQ(messages, (std::map<std::uint16_t, int>{{1, 50}, {2, 50}}));
}

TEST_F(McapContent, BuffersOfNoKnownTimeAreOfNow) {
  const auto before = static_cast<std::uint64_t>(g_get_real_time()) * 1'000;
  const auto messages = Write(kSlices, {Slice(1, 0, GST_CLOCK_TIME_NONE)});
  const auto after = static_cast<std::uint64_t>(g_get_real_time()) * 1'000;
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_GE(messages[0].header.log_time, before);
  EXPECT_LE(messages[0].header.log_time, after);
}

TEST_F(McapContent, OdometrySaysWhatMovesInWhat) {
  const auto messages = WriteZeros("application/x-odometry,frame-id=map,child-frame-id=os", 64);
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0].topic, "/odometry");
  const auto odometry = cdr::ReadOdometry(ViewOf(messages[0]));
  ASSERT_TRUE(odometry);
  EXPECT_EQ(odometry->header.frame_id, "map");
  EXPECT_EQ(odometry->child_frame_id, "front");
  EXPECT_EQ(StampOf(odometry->header), kCapture);
  EXPECT_EQ(odometry->twist_covariance[0], 1e6);
}

TEST_F(McapContent, SamplesOfAnImuNameTheirFrame) {
  const auto messages = WriteZeros(kImu, 32);
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0].topic, "/imu");
  EXPECT_EQ(cdr::ReadImu(ViewOf(messages[0]))->header.frame_id, "front");
}

TEST_F(McapContent, SamplesOfAnImuWhoseClockIsSetMeanwhileStayTogether) {
  GstBuffer* samples = gst_buffer_new_allocate(nullptr, 3 * 32, nullptr);
  gst_buffer_memset(samples, 0, 0, 3 * 32);
  const std::array<guint64, 3> times = {GST_SECOND, GST_SECOND + 5 * GST_MSECOND, kCapture};
  for (gsize i = 0; i < times.size(); ++i)
    gst_buffer_fill(samples, i * 32, &times[i], sizeof times[i]);
  GST_BUFFER_PTS(samples) = 0;
  gst_lidar_buffer_set_capture_time(samples, kCapture);
  const auto messages = Write(kImu, {samples});
  ASSERT_EQ(messages.size(), 3U);
  EXPECT_EQ(messages[0].header.log_time, kCapture);
  EXPECT_EQ(messages[1].header.log_time, kCapture + 5 * GST_MSECOND);
  EXPECT_EQ(messages[2].header.log_time, kCapture + 5 * GST_MSECOND);
  EXPECT_EQ(messages[2].header.publish_time, kCapture);
}

TEST_F(McapContent, FramesAreThoseOfTheCapsUnlessOneIsSet) {
  sensor_frame_ = nullptr;
  const auto frames = [](const cdr::Odometry& o) {
    return o.header.frame_id + " " + o.child_frame_id;
  };
  auto messages = WriteZeros("application/x-odometry,frame-id=map,child-frame-id=odom", 64);
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(frames(*cdr::ReadOdometry(ViewOf(messages[0]))), "map odom");
  messages = WriteZeros("application/x-odometry", 64);
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(frames(*cdr::ReadOdometry(ViewOf(messages[0]))), "odom lidar");
  messages = WriteZeros(kImu, 32);
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(cdr::ReadImu(ViewOf(messages[0]))->header.frame_id, "imu");
  messages = WriteZeros(std::string(kImu) + ",frame-id=os_imu", 32);
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(cdr::ReadImu(ViewOf(messages[0]))->header.frame_id, "os_imu");
  messages = WriteZeros(std::string(kSlices) + ",frame-id=os", 10);
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(cdr::ReadCodedSlice(ViewOf(messages[0]))->header.frame_id, "os");
}

TEST_F(McapContent, CloudsSayWhetherTheyAreDense) {
  for (const char* dense : {"false", "true"}) {
    const std::string caps =
        std::string(
            "application/x-pointcloud2,width=2,height=1,point-step=12,framerate=10/1,"
            "fields=(string)\"x:F32:0,y:F32:4,z:F32:8\",is-dense=") +
        dense;
    const auto messages = WriteZeros(caps, 24);
    ASSERT_EQ(messages.size(), 1U);
    const auto message = cdr::ReadPointCloud2(ViewOf(messages[0]));
    ASSERT_TRUE(message);
    EXPECT_EQ(message->header.frame_id, "front");
    EXPECT_EQ(message->is_dense, std::string("true") == dense);
    EXPECT_EQ(messages[0].header.publish_time, kCapture);
    const auto played = Play("mcapsrc" + At("a.mcap") + " ! fakesink name=see");
    EXPECT_NE(played.caps.at("see").find(std::string("is-dense=(boolean)") + dense),
              std::string::npos);
  }
}

TEST_F(McapContent, TheSinkCountsAndTellsWhatItWrote) {
  const auto recorded =
      Play(kSensor + " num-buffers=80 ! lidarenc ! identity name=see ! mcapsink name=m " +
           "max-file-duration=300000000 chunk-duration=100000000" + At("r-%d.mcap"));
  std::size_t bytes = 0;
  for (const Kept& kept : recorded.buffers.at("see")) bytes += kept.bytes.size();
  EXPECT_EQ(recorded.stats.at("messages"), 80U);
  EXPECT_GE(recorded.stats.at("bytes"), bytes);
  EXPECT_LT(recorded.stats.at("bytes"),
            // The other parts of a message have less than 100 bytes.
            bytes + 80 * 100);
  EXPECT_EQ(recorded.stats.at("files"), 4U);
  EXPECT_EQ(recorded.stats.at("chunks"), 10U);
  ASSERT_EQ(recorded.complete.size(), 4U);
  for (const CompleteFile& file : recorded.complete) {
    const auto messages = MessagesOf(file.location);
    ASSERT_FALSE(messages.empty());
    EXPECT_EQ(file.messages, messages.size());
    EXPECT_EQ(file.size, std::filesystem::file_size(file.location));
    EXPECT_EQ(file.start_time, messages.front().header.log_time);
    EXPECT_EQ(file.end_time, messages.back().header.log_time);
  }
}

TEST_F(McapContent, EachRecordingOfASinkBeginsAnew) {
  const Harness h = RecordingTo(Path("r-%d.mcap"));
  const Harness other(gst_harness_new_with_element(h->element, "sink_1", nullptr));
  SetPlaying(h.get());
  for (const bool first : {true, false}) {
    // The second recording begins an hour before the first one.
    const GstClockTime start = first ? kCapture : kCapture - 3600 * GST_SECOND;
    const std::string topic = first ? "/slices" : "/rear";
    if (!first) gst_child_proxy_set(GST_CHILD_PROXY(h->element), "sink_0::topic", "/rear", nullptr);
    for (GstHarness* stream : {h.get(), other.get()}) Begin(stream, kSlices);
    for (guint i = 0; i < 3; ++i) {
      const GstClockTime pts = (i + 1) * GST_MSECOND;
      EXPECT_EQ(gst_harness_push(h.get(), Slice(1, pts, start + i * GST_MSECOND)), GST_FLOW_OK);
      // Only stream `other` ends here, so the recording must continue. The end of stream `h` in the
      // first recording must have no effect.
      if (!first && i == 0) End(other.get());
    }
    EXPECT_EQ(StatOf(h->element, "messages"), 3U);
    if (first) End(h.get());
    gst_element_set_state(h->element, GST_STATE_READY);
    gst_element_set_state(h->element, GST_STATE_PLAYING);
    const auto messages = MessagesOf(Path(first ? "r-0.mcap" : "r-1.mcap"));
    ASSERT_EQ(messages.size(), 3U) << topic;
    EXPECT_EQ(messages[0].topic, topic);
    EXPECT_EQ(messages[0].header.log_time, start);
    EXPECT_EQ(messages[0].header.sequence, 0U);
  }
}

TEST_F(McapContent, EachRecordingOfASinkHasTheUsualTopics) {
  const Harness h = RecordingTo(Path("r-%d.mcap"));
  const Harness other(gst_harness_new_with_element(h->element, "sink_1", nullptr));
  SetPlaying(h.get());
  for (const char* file : {"r-0.mcap", "r-1.mcap"}) {
    for (GstHarness* stream : {h.get(), other.get()}) {
      Begin(stream, kSlices);
      EXPECT_EQ(gst_harness_push(stream, Slice(1, 0, kCapture)), GST_FLOW_OK);
    }
    for (GstHarness* stream : {h.get(), other.get()}) End(stream);
    EXPECT_EQ(StatOf(h->element, "files"), 1U);
    gst_element_set_state(h->element, GST_STATE_READY);
    gst_element_set_state(h->element, GST_STATE_PLAYING);
    std::vector<std::string> topics;
    for (const Logged& message : MessagesOf(Path(file))) topics.push_back(message.topic);
    EXPECT_EQ(topics, (std::vector<std::string>{"/slices", "/slices_1"})) << file;
    for (const char* count : {"messages", "bytes", "files", "chunks"})
      EXPECT_EQ(StatOf(h->element, count), 0U) << count;
  }
}

TEST_F(McapContent, AFlushedStreamGoesOnWhereItWas) {
  const Harness h = RecordingTo(Path("a.mcap"));
  const Harness other(gst_harness_new_with_element(h->element, "sink_1", nullptr));
  SetPlaying(h.get());
  for (GstHarness* stream : {h.get(), other.get()}) Begin(stream, kSlices);
  for (guint i = 0; i < 3; ++i)
    gst_harness_push(h.get(), Slice(1, i * GST_SECOND, kCapture + i * GST_SECOND));
  End(h.get());
  Flush(h.get());
  End(other.get());  // the first stream continues
  for (guint i = 0; i < 2; ++i)
    EXPECT_EQ(gst_harness_push(h.get(), Slice(2, i * GST_SECOND, kCapture)), GST_FLOW_OK);
  End(h.get());
  std::vector<GstClockTime> times;
  for (const Logged& message : MessagesOf(Path("a.mcap")))
    times.push_back((message.header.log_time - kCapture) / GST_SECOND);
  EXPECT_EQ(times, (std::vector<GstClockTime>{0, 1, 2, 2, 3}));
}

TEST_F(McapContent, OtherCapsAreAnotherChannelOfTheSameTopic) {
  {
    const Harness h = RecordingTo(Path("a.mcap"));
    SetPlaying(h.get());
    for (const char* more : {",codec-data=(buffer)01", ",codec-data=(buffer)02"}) {
      gst_harness_set_src_caps_str(h.get(), (std::string(kSlices) + more).c_str());
      gst_harness_push(h.get(), Slice(1, 0, kCapture));
    }
    End(h.get());
  }
  const auto played = Play("mcapsrc" + At("a.mcap") + " ! fakesink name=see");
  EXPECT_EQ(played.buffers.at("see").size(), 2U);
  EXPECT_NE(played.caps.at("see").find("codec-data=(buffer)02"), std::string::npos);
}

TEST_F(McapContent, SlicesThatCannotBeAreDroppedAndCounted) {
  const auto of = [](guint index, guint count) {
    GstBuffer* buffer = Slice(1, index * GST_MSECOND, kCapture);
    const GstLidarSlice place{1, index, count, 0};
    gst_lidar_buffer_set_slice(buffer, &place);
    return buffer;
  };
  Write(kSlices, {of(0, 4096), of(1, 4097), of(2, 2), of(3, 4), of(4, 5)});
  const auto played = Play("mcapsrc name=m" + At("a.mcap") + " ! fakesink name=see");
  const auto& slices = played.buffers.at("see");
  ASSERT_EQ(slices.size(), 3U);
  EXPECT_EQ(slices[0].slice.slice_count, 4096U);
  EXPECT_EQ(slices[1].slice.slice_count, 4U);
  EXPECT_TRUE(slices[0].discont);
  EXPECT_TRUE(slices[1].discont);  // the slice before this one is missing
  EXPECT_FALSE(slices[2].discont);
  EXPECT_EQ(played.stats.at("messages"), 5U);
  EXPECT_EQ(played.stats.at("messages-dropped"), 2U);
}

TEST_F(McapContent, GapsFillWhatASilentStreamLeavesOpen) {
  {
    const Harness h = RecordingTo(Path("a.mcap"));
    const Harness silent(gst_harness_new_with_element(h->element, "sink_1", nullptr));
    SetPlaying(h.get());
    for (GstHarness* stream : {h.get(), silent.get()}) Begin(stream, kSlices);
    for (guint i = 0; i < 30; ++i) {
      const GstClockTime pts = i * 100 * GST_MSECOND;
      gst_harness_push(h.get(), Slice(1, pts, kCapture + pts));
      if (i != 10 && i != 29) continue;
      GstBuffer* late = Slice(2, pts + 50 * GST_MSECOND, kCapture + pts + 50 * GST_MSECOND);
      GST_BUFFER_DURATION(late) = 300 * GST_MSECOND;
      gst_harness_push(silent.get(), late);
    }
    for (GstHarness* stream : {h.get(), silent.get()}) End(stream);
  }
  Pipeline p("mcapsrc name=m" + At("a.mcap") +
             " m.src_0 ! queue ! fakesink name=see0 m.src_1 ! queue ! fakesink name=see1");
  gst_element_set_state(p.get(), GST_STATE_PLAYING);
  ASSERT_TRUE(p.Wait(GST_MESSAGE_EOS));
  // The start and the length of each gap [ms].
  using Gaps = std::vector<std::pair<GstClockTime, GstClockTime>>;
  EXPECT_EQ(p.outcome().gaps["see1"],
            (Gaps{{0, 500}, {500, 500}, {1'350, 550}, {1'900, 500}, {2'400, 500}}));
  EXPECT_EQ(p.outcome().gaps["see0"], Gaps{});
  // After a seek, the first gap event of the silent stream begins at the position of the seek.
  p.Forget();
  ASSERT_TRUE(
      gst_element_seek_simple(p.get(), GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, 1'500 * GST_MSECOND));
  ASSERT_TRUE(p.Wait(GST_MESSAGE_EOS));
  EXPECT_EQ(p.outcome().gaps["see1"], (Gaps{{1'500, 500}, {2'000, 500}}));
}

TEST_F(McapContent, SamplesBesideSlicesDoNotEndAFileWithinAScan) {
  {
    const gst::ElementPtr sink(gst_parse_launch(
        ("mcapsink max-file-duration=100000000" + At("r-%d.mcap")).c_str(), nullptr));
    const Harness h(gst_harness_new_with_element(sink.get(), "sink_0", nullptr));
    const Harness imu(gst_harness_new_with_element(sink.get(), "sink_1", nullptr));
    SetPlaying(h.get());
    Begin(h.get(), kSlices);
    Begin(imu.get(), kImu);
    const auto push = [&](guint scan, guint index, GstClockTime ms) {
      GstBuffer* buffer = Slice(1, ms * GST_MSECOND, kCapture + ms * GST_MSECOND);
      const GstLidarSlice place{scan, index, 2, 0};
      gst_lidar_buffer_set_slice(buffer, &place);
      EXPECT_EQ(gst_harness_push(h.get(), buffer), GST_FLOW_OK);
    };
    push(0, 0, 0);
    push(0, 1, 50);
    push(1, 0, 90);
    GstBuffer* sample = gst_buffer_new_allocate(nullptr, 32, nullptr);
    gst_buffer_memset(sample, 0, 0, 32);
    GST_BUFFER_PTS(sample) = 105 * GST_MSECOND;
    EXPECT_EQ(gst_harness_push(imu.get(), sample), GST_FLOW_OK);
    push(1, 1, 110);
    push(2, 0, 120);
    for (GstHarness* stream : {h.get(), imu.get()}) End(stream);
  }
  EXPECT_EQ(MessagesOf(Path("r-0.mcap")).size(), 5U);
  EXPECT_EQ(MessagesOf(Path("r-1.mcap")).size(), 1U);
}

TEST_F(McapContent, CloudsBeginAFileWhereThereAreNoSlices) {
  const auto recorded = Play(kSensor + " num-buffers=80 ! scanassembler ! mcapsink name=m " +
                             "max-file-duration=300000000" + At("r-%d.mcap"));
  EXPECT_EQ(recorded.stats.at("files"), 4U);
  EXPECT_EQ(MessagesOf(Path("r-0.mcap")).size(), 3U);
}

TEST(McapTimeline, KeepsTheDistancesOfRunningTimes) {
  gst::Timeline line;
  EXPECT_EQ(line.LogTime({{}, 70, 50}), 70U);
  EXPECT_EQ(line.LogTime({{}, {}, 50}), 50U);
  EXPECT_EQ(line.LogTime({1'000, 5'000, 1}), 5'000U);
  EXPECT_EQ(line.LogTime({1'010, 9'999, 1}), 5'010U);
  EXPECT_EQ(line.LogTime({990, {}, 1}), 4'990U);
  EXPECT_EQ(line.LogTime({{}, 1, 1}), 5'010U);
  line.Restart();
  // A log time is never earlier than the newest log time.
  EXPECT_EQ(line.LogTime({3, 2'000, 1}), 5'010U);
  EXPECT_EQ(line.LogTime({4, 2'000, 1}), 5'011U);
  line.Restart();
  EXPECT_EQ(line.LogTime({0, 8'000, 1}), 8'000U);
  EXPECT_EQ(gst::Timeline().LogTime({5, {}, 77}), 77U);
}

}  // namespace
}  // namespace lidar::test
