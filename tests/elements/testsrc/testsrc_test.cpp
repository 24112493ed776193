// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "gst/common/buffer_map.h"
#include "gst/lidar/cloud_info.h"
#include "src/base/imu_sample.h"
#include "src/cloud/range_projection.h"
#include "tests/support/clock_wait.h"
#include "tests/support/element_bus.h"
#include "tests/support/harness.h"
#include "tests/support/patience.h"
#include "tests/support/small_disk.h"

namespace lidar::gst {
namespace {

using test::Harness;
using test::SetPlaying;

Harness Launch(const std::string& properties) {
  Harness h(gst_harness_new_parse(("lidartestsrc " + properties).c_str()));
  return h;
}

BufferPtr Pull(const Harness& h) { return BufferPtr(gst_harness_pull(h.get())); }

GstLidarSlice SliceOf(const BufferPtr& buffer) {
  GstLidarSlice slice{};
  EXPECT_TRUE(gst_lidar_buffer_get_slice(buffer.get(), &slice));
  return slice;
}

std::vector<guint8> BytesOf(const BufferPtr& buffer) {
  const BufferMap map(buffer.get(), GST_MAP_READ);
  return {map.data(), map.data() + map.size()};
}

struct Point {
  float x, y, z, intensity;
  std::uint32_t range;
};
static_assert(sizeof(Point) == 20);

std::vector<Point> PointsOf(const BufferPtr& buffer) {
  const auto bytes = BytesOf(buffer);
  std::vector<Point> points(bytes.size() / sizeof(Point));
  std::memcpy(points.data(), bytes.data(), points.size() * sizeof(Point));
  return points;
}

CloudInfo InfoOf(const Harness& h) {
  const CapsPtr caps(gst_pad_get_current_caps(h->sinkpad));
  auto info = CloudInfo::FromCaps(caps.get());
  EXPECT_TRUE(info);
  return *info;
}

TEST(LidarTestSrc, CapsDescribeTheSlicesOfTheSensor) {
  const Harness h = Launch("model=os1-128 mode=2048x10");
  SetPlaying(h.get());
  const BufferPtr buffer = Pull(h);
  const CloudInfo info = InfoOf(h);
  EXPECT_EQ(info.width, 256U);
  EXPECT_EQ(info.height, 128U);
  EXPECT_EQ(info.framerate_n, 10);
  EXPECT_EQ(info.fields.ToString(), "x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,range:U32:16");
  ASSERT_TRUE(info.sensor_model);
  EXPECT_EQ(info.sensor_model->columns_per_scan, 2048U);
  EXPECT_EQ(gst_buffer_get_size(buffer.get()), info.FrameSize());
}

TEST(LidarTestSrc, TellsOnlyTheCapsThatAreAskedFor) {
  const ElementPtr source(gst_parse_launch("lidartestsrc model=os1-32", nullptr));
  const PadPtr pad(gst_element_get_static_pad(source.get(), "src"));
  for (const gint height : {32, 64}) {
    const CapsPtr filter(
        gst_caps_new_simple("application/x-pointcloud2", "height", G_TYPE_INT, height, nullptr));
    const CapsPtr caps(gst_pad_query_caps(pad.get(), filter.get()));
    EXPECT_EQ(gst_caps_is_empty(caps.get()) != FALSE, height != 32) << height;
  }
}

TEST(LidarTestSrc, StampsAreTheSweepOfEachSlice) {
  const Harness h = Launch("model=os1-32 mode=512x20");
  SetPlaying(h.get());
  for (guint i = 0; i < 12; ++i) {
    const BufferPtr buffer = Pull(h);
    const GstLidarSlice slice = SliceOf(buffer);
    EXPECT_EQ(slice.scan_id, i / 4);
    EXPECT_EQ(slice.slice_index, i % 4);
    EXPECT_EQ(slice.slice_count, 4U);
    EXPECT_EQ(slice.first_column, i % 4 * 128);
    EXPECT_EQ(GST_BUFFER_PTS(buffer.get()), i * 12'500'000);
    EXPECT_EQ(GST_BUFFER_DURATION(buffer.get()), 12'500'000U);
    // If the source is not live, capture times begin at 2024-01-01, so that they are the same in
    // each run.
    EXPECT_EQ(gst_lidar_buffer_get_capture_time(buffer.get()),
              1'704'067'200 * GST_SECOND + GST_BUFFER_PTS(buffer.get()));
  }
}

TEST(LidarTestSrc, PointsAreWhatTheRangesAndTheSensorModelSay) {
  const Harness h = Launch("model=os0-32 mode=512x10 slices-per-scan=4");
  SetPlaying(h.get());
  const BufferPtr first = Pull(h);
  const BufferPtr second = Pull(h);
  const RangeProjection projection(*InfoOf(h).sensor_model);
  const auto points = PointsOf(second);
  ASSERT_EQ(points.size(), 32U * 128);
  int missing = 0;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const auto p = projection.Point(i / 128, 128 + i % 128, points[i].range);
    EXPECT_EQ(points[i].x, p[0]);
    EXPECT_EQ(points[i].z, p[2]);
    if (points[i].range != 0) continue;
    ++missing;
    EXPECT_EQ(points[i].intensity, 0);
  }
  EXPECT_GT(missing, 50);
  EXPECT_LT(missing, 2500);
}

TEST(LidarTestSrc, TheSameSeedGivesTheSameCloudsOverRestarts) {
  const auto sweep = [](const std::string& properties) {
    const Harness h = Launch("model=os1-32 mode=512x10 num-buffers=2 " + properties);
    std::vector<std::vector<guint8>> runs;
    for (int run = 0; run < 2; ++run) {
      SetPlaying(h.get());
      BytesOf(Pull(h));
      runs.push_back(BytesOf(Pull(h)));
      gst_element_set_state(h->element, GST_STATE_NULL);
    }
    EXPECT_EQ(runs[0], runs[1]);
    return runs[0];
  };
  const auto one = sweep("seed=1");
  EXPECT_EQ(one, sweep("seed=1"));
  EXPECT_NE(one, sweep("seed=2"));
  EXPECT_NE(one, sweep("seed=1 scene=field"));
}

TEST(LidarTestSrc, SlicesThatDoNotDivideTheColumnsAreRoundedDown) {
  const Harness h = Launch("model=os1-32 mode=512x10 slices-per-scan=15");
  SetPlaying(h.get());
  EXPECT_EQ(SliceOf(Pull(h)).slice_count, 8U);
}

TEST(LidarTestSrc, EndsAfterNumBuffersAndStartsAgainWithTheFirstScan) {
  const Harness h = Launch("model=os1-32 mode=512x10 slices-per-scan=1 num-buffers=3");
  for (int run = 0; run < 3; ++run) {
    SetPlaying(h.get());
    for (guint i = 0; i < 3; ++i) EXPECT_EQ(SliceOf(Pull(h)).scan_id, i);
    bool eos = false;
    while (!eos) {
      const EventPtr event(gst_harness_pull_event(h.get()));
      ASSERT_TRUE(event);
      eos = GST_EVENT_TYPE(event.get()) == GST_EVENT_EOS;
    }
    gst_element_set_state(h->element, GST_STATE_NULL);
  }
}

TEST(LidarTestSrc, ALiveSliceLeavesWhenItsLastColumnIsSampled) {
  const Harness h = Launch("is-live=true model=os1-32 mode=512x10");
  test::UseTestClock(h.get());
  SetPlaying(h.get());
  for (guint i = 1; i <= 10; ++i) {
    ASSERT_TRUE(gst_harness_wait_for_clock_id_waits(h.get(), 1, test::kPatience.count()));
    EXPECT_EQ(gst_test_clock_get_next_entry_time(GST_TEST_CLOCK(GST_ELEMENT_CLOCK(h->element))),
              test::kClockStart + i * 12'500'000);
    EXPECT_EQ(gst_harness_buffers_in_queue(h.get()), 0U);
    ASSERT_TRUE(gst_harness_crank_single_clock_wait(h.get()));
    const BufferPtr buffer = Pull(h);
    EXPECT_EQ(GST_BUFFER_PTS(buffer.get()), (i - 1) * 12'500'000);
  }
}

TEST(LidarTestSrc, ALiveSourceSaysItIsLateByOneSlice) {
  const Harness h = Launch("is-live=true model=os1-32 mode=1024x10");
  test::UseTestClock(h.get());
  SetPlaying(h.get());
  const QueryPtr query(gst_query_new_latency());
  ASSERT_TRUE(gst_pad_peer_query(h->sinkpad, query.get()));
  gboolean live = FALSE;
  GstClockTime min = 0;
  GstClockTime max = 0;
  gst_query_parse_latency(query.get(), &live, &min, &max);
  EXPECT_TRUE(live);
  EXPECT_NEAR(static_cast<double>(min), 12.5e6, 2);
  EXPECT_EQ(max, GST_CLOCK_TIME_NONE);
}

/// Wakes the thread that waits for the clock, although its time has already passed. The test clock
/// does not do this by itself.
void ReleaseWaiter(const Harness& h) {
  ASSERT_TRUE(gst_harness_wait_for_clock_id_waits(h.get(), 1, test::kPatience.count()));
  gst_clock_id_unref(
      gst_test_clock_process_next_clock_id(GST_TEST_CLOCK(GST_ELEMENT_CLOCK(h->element))));
}

TEST(LidarTestSrc, ALiveSourceThatIsScansLateSkipsToThePresent) {
  const Harness h = Launch("is-live=true model=os1-32 mode=512x10");
  test::UseTestClock(h.get());
  SetPlaying(h.get());
  ASSERT_TRUE(gst_harness_wait_for_clock_id_waits(h.get(), 1, test::kPatience.count()));
  gst_harness_set_time(h.get(), test::kClockStart + 1'030 * GST_MSECOND);
  ReleaseWaiter(h);
  EXPECT_EQ(SliceOf(Pull(h)).scan_id, 0U);  // the source waited with this slice
  ReleaseWaiter(h);
  const BufferPtr next = Pull(h);
  EXPECT_EQ(SliceOf(next).scan_id, 10U);
  EXPECT_EQ(SliceOf(next).slice_index, 0U);
  EXPECT_TRUE(GST_BUFFER_IS_DISCONT(next.get()));
  EXPECT_EQ(GST_BUFFER_PTS(next.get()), GST_SECOND);
}

/// The clock of a pipeline goes on while one of its sources is stopped.
TEST(LidarTestSrc, ALiveSourceBeginsWithItsFirstScanWheneverItStarts) {
  const Harness h = Launch("is-live=true model=os1-32 mode=512x10");
  test::UseTestClock(h.get());
  for (const GstClockTime start : {GstClockTime{0}, GstClockTime{10 * GST_SECOND}}) {
    gst_harness_set_time(h.get(), test::kClockStart + start);
    SetPlaying(h.get());
    ASSERT_TRUE(test::AwaitClockWait(h.get(), test::kClockStart + start + 12'500'000));
    ASSERT_TRUE(gst_harness_crank_single_clock_wait(h.get()));
    const BufferPtr first = Pull(h);
    EXPECT_EQ(SliceOf(first).scan_id, 0U);
    EXPECT_EQ(SliceOf(first).slice_index, 0U);
    EXPECT_EQ(GST_BUFFER_PTS(first.get()), start);
    gst_element_set_state(h->element, GST_STATE_READY);
  }
}

TEST(LidarTestSrc, CaptureTimesAfterAPauseAreThoseOfTheDay) {
  const Harness h = Launch("is-live=true model=os1-32 mode=512x10");
  test::UseTestClock(h.get());
  SetPlaying(h.get());
  // The test clock does not advance during the pause, just as the running time of a pipeline does
  // not.
  ASSERT_TRUE(test::AwaitClockWait(h.get(), test::kClockStart + 12'500'000));
  gst_element_set_state(h->element, GST_STATE_PAUSED);
  const auto resumed = static_cast<GstClockTime>(g_get_real_time()) * GST_USECOND;
  gst_element_set_state(h->element, GST_STATE_PLAYING);
  ASSERT_TRUE(test::AwaitClockWait(h.get(), test::kClockStart + 12'500'000));
  ASSERT_TRUE(gst_harness_crank_single_clock_wait(h.get()));
  const BufferPtr first = Pull(h);
  EXPECT_EQ(GST_BUFFER_PTS(first.get()), 0U);
  EXPECT_GE(gst_lidar_buffer_get_capture_time(first.get()), resumed);
}

TEST(LidarTestSrc, ALiveSourceStopsWhileItWaits) {
  for (int run = 0; run < 3; ++run) {
    const Harness h = Launch("is-live=true model=os1-32 mode=512x10");
    test::UseTestClock(h.get());
    SetPlaying(h.get());
    ASSERT_TRUE(gst_harness_wait_for_clock_id_waits(h.get(), 1, test::kPatience.count()));
  }
}

TEST(LidarTestSrc, WritesTheTrajectoryAtTheCaptureTimes) {
  const std::string path = ::testing::TempDir() + "trajectory.tum";
  {
    const Harness h =
        Launch("model=os1-32 mode=512x10 speed=10 num-buffers=16 trajectory-location=" + path);
    SetPlaying(h.get());
    for (int i = 0; i < 16; ++i) Pull(h);
  }
  std::ifstream file(path);
  std::string line;
  ASSERT_TRUE(std::getline(file, line));
  EXPECT_EQ(line, "# timestamp tx ty tz qx qy qz qw");
  int i = 0;
  for (; std::getline(file, line); ++i) {
    std::istringstream fields(line);
    double t = 0, x = 0, y = 0, z = 0, qx = 0, qy = 0, qz = 0, qw = 0;
    ASSERT_TRUE(fields >> t >> x >> y >> z >> qx >> qy >> qz >> qw) << line;
    EXPECT_NEAR(t, 1'704'067'200 + i * 0.0125, 1e-6);
    EXPECT_NEAR(x, i * 0.125, 1e-5);
    EXPECT_NEAR(qx * qx + qy * qy + qz * qz + qw * qw, 1, 1e-6);
  }
  EXPECT_EQ(i, 16);
  std::filesystem::remove(path);
}

TEST(LidarTestSrc, TellsOnceThatTheTrajectoryDoesNotFit) {
  const std::string path = ::testing::TempDir() + "long_trajectory.tum";
  std::vector<std::string> warnings;
  {
    const test::SmallDisk disk(300);
    const Harness h = Launch("model=os1-32 mode=512x10 num-buffers=16 trajectory-location=" + path);
    const test::ElementBus bus(h->element);
    SetPlaying(h.get());
    for (int i = 0; i < 16; ++i) Pull(h);
    warnings = bus.Texts(GST_MESSAGE_WARNING);
  }
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("The trajectory can no longer be written"), std::string::npos);
  EXPECT_GT(std::filesystem::file_size(path), 0U);
  std::filesystem::remove(path);
}

TEST(LidarTestSrc, ChannelsAreFieldsBehindTheOthers) {
  const Harness h = Launch("model=os1-32 mode=512x10 channels=\"ring , t,signal\"");
  SetPlaying(h.get());
  const BufferPtr buffer = Pull(h);
  EXPECT_EQ(InfoOf(h).fields.ToString(),
            "x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,range:U32:16,ring:U16:20,t:U32:22,"
            "signal:U16:26");
  const auto bytes = BytesOf(buffer);
  ASSERT_EQ(bytes.size(), 32U * 64 * 28);
  for (std::uint32_t i = 0; i < 32 * 64; ++i) {
    std::uint16_t ring = 0, signal = 0;
    std::uint32_t t = 0, range = 0;
    std::memcpy(&range, &bytes[i * 28 + 16], sizeof range);
    std::memcpy(&ring, &bytes[i * 28 + 20], sizeof ring);
    std::memcpy(&t, &bytes[i * 28 + 22], sizeof t);
    std::memcpy(&signal, &bytes[i * 28 + 26], sizeof signal);
    EXPECT_EQ(ring, i / 64);
    EXPECT_EQ(t, i % 64 * 100'000'000ULL / 512);
    EXPECT_EQ(signal > 0, range > 0);
  }
}

/// Returns the error of a pipeline that fails to start, or null if it posts no error.
ErrorPtr ErrorOfStart(const char* launch) {
  const ElementPtr pipeline(gst_parse_launch(launch, nullptr));
  EXPECT_EQ(gst_element_set_state(pipeline.get(), GST_STATE_PAUSED), GST_STATE_CHANGE_FAILURE);
  const test::ElementBus bus(pipeline.get());
  const MessagePtr message = bus.Pop(GST_MESSAGE_ERROR);
  GError* raw = nullptr;
  if (message) gst_message_parse_error(message.get(), &raw, nullptr);
  gst_element_set_state(pipeline.get(), GST_STATE_NULL);
  return ErrorPtr(raw);
}

TEST(LidarTestSrc, SaysWhichChannelItDoesNotHave) {
  const ErrorPtr error = ErrorOfStart("lidartestsrc channels=ring,nonsense ! fakesink");
  ASSERT_TRUE(error);
  EXPECT_NE(std::string(error->message).find("\"nonsense\""), std::string::npos);
}

TEST(LidarTestSrc, TakesNoChannelsWhereADriverChoosesTheFields) {
  const ErrorPtr error = ErrorOfStart("lidartestsrc model=xt32 channels=signal ! fakesink");
  ASSERT_TRUE(error);
  EXPECT_NE(std::string(error->message).find("do not set channels"), std::string::npos);
}

TEST(LidarTestSrc, SaysWhichTrajectoryItCannotWrite) {
  const ErrorPtr error =
      ErrorOfStart("lidartestsrc trajectory-location=/nonexistent/t.tum ! fakesink");
  ASSERT_TRUE(error);
  EXPECT_TRUE(g_error_matches(error.get(), GST_RESOURCE_ERROR, GST_RESOURCE_ERROR_OPEN_WRITE));
  EXPECT_NE(std::string(error->message).find("/nonexistent/t.tum"), std::string::npos);
}

TEST(LidarTestSrc, RefusesCapsThatAreNotItsOwn) {
  const ElementPtr pipeline(
      gst_parse_launch("lidartestsrc ! application/x-pointcloud2,height=7 ! fakesink", nullptr));
  gst_element_set_state(pipeline.get(), GST_STATE_PAUSED);
  const test::ElementBus bus(pipeline.get());
  const MessagePtr message = bus.Wait(GST_MESSAGE_ERROR);
  EXPECT_TRUE(message);
  gst_element_set_state(pipeline.get(), GST_STATE_NULL);
}

/// The caps contain the size of the first cloud. Making this cloud takes long, so the stop comes
/// before the caps.
TEST(LidarTestSrc, AStopBeforeItsFirstCapsIsNoError) {
  const ElementPtr pipeline(gst_parse_launch("lidartestsrc model=at128 ! fakesink", nullptr));
  g_object_set(pipeline.get(), "auto-flush-bus", FALSE, nullptr);
  gst_element_set_state(pipeline.get(), GST_STATE_PAUSED);
  g_usleep(50'000);
  gst_element_set_state(pipeline.get(), GST_STATE_NULL);
  const test::ElementBus bus(pipeline.get());
  EXPECT_FALSE(bus.Pop(GST_MESSAGE_ERROR));
}

/// The buffers that a source pushes from its pads until EOS.
struct Played {
  std::vector<BufferPtr> clouds;
  std::vector<BufferPtr> samples;
  CapsPtr caps;  // of the samples
};

void Collect(GstElement*, GstBuffer* buffer, GstPad*, std::vector<BufferPtr>* to) {
  to->emplace_back(gst_buffer_ref(buffer));
}

Played PlayWithImu(GstElement* pipeline) {
  Played run;
  const auto collect = [&](const char* name, std::vector<BufferPtr>* to) -> ElementPtr {
    ElementPtr sink(gst_bin_get_by_name(GST_BIN(pipeline), name));
    g_signal_connect(sink.get(), "handoff", G_CALLBACK(Collect), to);
    return sink;
  };
  const ElementPtr clouds = collect("clouds", &run.clouds);
  const ElementPtr samples = collect("samples", &run.samples);
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  const test::ElementBus bus(pipeline);
  const MessagePtr end = bus.Wait(GST_MESSAGE_EOS | GST_MESSAGE_ERROR);
  EXPECT_TRUE(end && GST_MESSAGE_TYPE(end.get()) == GST_MESSAGE_EOS);
  const PadPtr pad(gst_element_get_static_pad(samples.get(), "sink"));
  run.caps.reset(gst_pad_get_current_caps(pad.get()));
  gst_element_set_state(pipeline, GST_STATE_NULL);
  g_signal_handlers_disconnect_by_data(clouds.get(), &run.clouds);
  g_signal_handlers_disconnect_by_data(samples.get(), &run.samples);
  return run;
}

constexpr unsigned kSlices = 40;
ElementPtr MakeWithImu() {
  const std::string line =
      "lidartestsrc name=s imu=true model=os0-32 mode=512x10 speed=0 num-buffers=" +
      std::to_string(kSlices) +
      " ! fakesink name=clouds async=false signal-handoffs=true "
      "s.imu ! fakesink name=samples async=false signal-handoffs=true";
  return ElementPtr(gst_parse_launch(line.c_str(), nullptr));
}

std::vector<ImuSample> SamplesIn(const BufferPtr& buffer) {
  const BufferMap map(buffer.get(), GST_MAP_READ);
  EXPECT_EQ(map.size() % kImuSampleSize, 0U);
  std::vector<ImuSample> samples(map.size() / kImuSampleSize);
  ByteReader r(map.view());
  for (ImuSample& sample : samples) {
    sample.time += Duration{static_cast<std::int64_t>(r.Le64())};
    for (double& v : sample.acceleration) v = double{r.LeF32()};
    for (double& v : sample.angular_velocity) v = double{r.LeF32()};
  }
  return samples;
}

TEST(LidarTestSrc, GivesEachSampleOfItsImuWithTheSliceInWhichItWasTaken) {
  const ElementPtr pipeline = MakeWithImu();
  const Played run = PlayWithImu(pipeline.get());
  ASSERT_EQ(run.clouds.size(), kSlices);
  const GstStructure* s = gst_caps_get_structure(run.caps.get(), 0);
  EXPECT_STREQ(gst_structure_get_string(s, "fields"), kImuFields);
  std::int64_t expected = 1'704'067'200'000'000'000;
  auto slice = run.clouds.begin();
  for (const BufferPtr& buffer : run.samples) {
    const GstClockTime pts = GST_BUFFER_PTS(buffer.get());
    while (GST_BUFFER_PTS(slice->get()) + GST_BUFFER_DURATION(slice->get()) <= pts) ++slice;
    const GstClockTime end = GST_BUFFER_PTS(slice->get()) + GST_BUFFER_DURATION(slice->get());
    EXPECT_GE(pts, GST_BUFFER_PTS(slice->get()));
    EXPECT_EQ(gst_lidar_buffer_get_capture_time(buffer.get()), static_cast<GstClockTime>(expected));
    for (const ImuSample& sample : SamplesIn(buffer)) {
      EXPECT_EQ(sample.time.time_since_epoch().count(), expected);
      EXPECT_LT(sample.time.time_since_epoch().count() - 1'704'067'200'000'000'000,
                static_cast<std::int64_t>(end));
      EXPECT_NEAR(sample.acceleration[2], 9.8, 1);
      expected += 10'000'000;
    }
  }
  EXPECT_EQ(expected, 1'704'067'200'500'000'000);
}

TEST(LidarTestSrc, ItsImuGivesTheSameSamplesAgain) {
  const Played first = PlayWithImu(MakeWithImu().get());
  const Played again = PlayWithImu(MakeWithImu().get());
  ASSERT_EQ(first.samples.size(), again.samples.size());
  for (std::size_t i = 0; i < first.samples.size(); ++i)
    EXPECT_EQ(BytesOf(first.samples[i]), BytesOf(again.samples[i]));
}

/// A lidartestsrc with its IMU, on a test clock. Stores the buffers that the pad imu outputs.
class LiveImu {
 public:
  LiveImu() {
    gst_util_set_object_arg(G_OBJECT(h_->element), "mode", "512x10");
    g_object_set(h_->element, "imu", TRUE, "is-live", TRUE, nullptr);
    g_signal_connect(h_->element, "pad-added", G_CALLBACK(OnPad), &samples_);
    test::UseTestClock(h_.get());
    SetPlaying(h_.get());
  }
  const Harness& harness() const { return h_; }
  const std::vector<BufferPtr>& samples() const { return samples_; }

 private:
  static void OnPad(GstElement*, GstPad* pad, std::vector<BufferPtr>* samples) {
    gst_pad_add_probe(
        pad, GST_PAD_PROBE_TYPE_BUFFER,
        [](GstPad*, GstPadProbeInfo* info, gpointer kept) {
          static_cast<std::vector<BufferPtr>*>(kept)->emplace_back(
              gst_buffer_ref(GST_PAD_PROBE_INFO_BUFFER(info)));
          return GST_PAD_PROBE_OK;
        },
        samples, nullptr);
  }
  std::vector<BufferPtr> samples_;
  Harness h_{gst_harness_new_with_padnames("lidartestsrc", nullptr, "src")};
};

GstClockTime OffsetOf(const BufferPtr& buffer) {
  return gst_lidar_buffer_get_capture_time(buffer.get()) - GST_BUFFER_PTS(buffer.get());
}

TEST(LidarTestSrc, ALiveImuHasTheClockOfTheClouds) {
  const LiveImu live;
  const Harness& h = live.harness();
  for (std::size_t i = 1; i <= 10; ++i) {
    ASSERT_TRUE(gst_harness_wait_for_clock_id_waits(h.get(), 1, test::kPatience.count()));
    EXPECT_EQ(live.samples().size(), i - 1) << "samples leave with the slice of their sweep";
    ASSERT_TRUE(gst_harness_crank_single_clock_wait(h.get()));
    const BufferPtr cloud = Pull(h);
    ASSERT_EQ(live.samples().size(), i);
    EXPECT_EQ(OffsetOf(live.samples().back()), OffsetOf(cloud));
  }
}

TEST(LidarTestSrc, AnImuSkipsWithTheClouds) {
  const LiveImu live;
  const Harness& h = live.harness();
  ASSERT_TRUE(gst_harness_wait_for_clock_id_waits(h.get(), 1, test::kPatience.count()));
  gst_harness_set_time(h.get(), test::kClockStart + 1'030 * GST_MSECOND);
  ReleaseWaiter(h);
  Pull(h);  // the source waited with this slice
  ReleaseWaiter(h);
  EXPECT_EQ(GST_BUFFER_PTS(Pull(h).get()), GST_SECOND);
  ASSERT_EQ(live.samples().size(), 2U);
  EXPECT_GE(GST_BUFFER_PTS(live.samples().back().get()), GST_SECOND);
  EXPECT_EQ(SamplesIn(live.samples().back()).size(), 2U);
}

TEST(LidarTestSrc, HasNoImuUnlessItIsWanted) {
  const Harness h = Launch("num-buffers=2");
  SetPlaying(h.get());
  EXPECT_TRUE(Pull(h));
  EXPECT_EQ(h->element->numsrcpads, 1);
}

}  // namespace
}  // namespace lidar::gst
