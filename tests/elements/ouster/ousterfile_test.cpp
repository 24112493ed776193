// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of ouster_src that reads captures.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/elements/ouster/ouster_support.h"
#include "tests/support/clock_wait.h"

namespace lidar::test {
namespace {

using gst::BufferMap;
using gst::BufferPtr;
using gst::CapsPtr;
using gst::CloudInfo;

Harness FromFile(const std::string& pcap, const std::string& json, const char* more = "") {
  const std::string launch =
      "ouster_src location=" + DataPath(pcap) + " metadata=" + DataPath(json) + " " + more;
  Harness h(gst_harness_new_parse(launch.c_str()));
  SetPlaying(h.get());
  return h;
}

TEST(OusterFile, GivesOrganisedSlicesWithTimesAndTheSensorModel) {
  const Harness h = FromFile(kThreeScans, kThreeScansMetadata);
  const ouster::Metadata metadata = LoadMetadata(kThreeScansMetadata);
  GstClockTime last = 0;
  GstClockTime last_capture = 0;
  for (guint i = 0; i < 24; ++i) {
    const BufferPtr buffer(gst_harness_pull(h.get()));
    ASSERT_TRUE(buffer) << i;
    if (i == 0) {
      const CapsPtr caps(gst_pad_get_current_caps(h->sinkpad));
      const auto info = CloudInfo::FromCaps(caps.get());
      ASSERT_TRUE(info);
      EXPECT_EQ(info->width, 128U);
      EXPECT_EQ(info->height, 128U);
      EXPECT_EQ(info->point_step, 20U);
      EXPECT_EQ(info->fields.ToString(), "x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,range:U32:16");
      EXPECT_EQ(info->ScanDuration(), 100 * GST_MSECOND);
      ASSERT_TRUE(info->sensor_model);
      EXPECT_EQ(info->sensor_model->range_unit_mm, 8U);
      EXPECT_EQ(info->sensor_model->Serialise(), metadata.model.Serialise());
    }
    EXPECT_EQ(gst_buffer_get_size(buffer.get()), 128U * 128 * 20);
    GstLidarSlice slice{};
    ASSERT_TRUE(gst_lidar_buffer_get_slice(buffer.get(), &slice));
    EXPECT_EQ(slice.scan_id, i / 8);
    EXPECT_EQ(slice.slice_index, i % 8);
    EXPECT_EQ(slice.slice_count, 8U);
    EXPECT_EQ(slice.first_column, i % 8 * 128);
    EXPECT_EQ(GST_BUFFER_DURATION(buffer.get()), 12500 * GST_USECOND);
    const GstClockTime capture = gst_lidar_buffer_get_capture_time(buffer.get());
    if (i == 0) {
      EXPECT_EQ(GST_BUFFER_PTS(buffer.get()), 0U);
    } else {
      EXPECT_NEAR(static_cast<double>(GST_BUFFER_PTS(buffer.get()) - last), 12.5e6, 2e5);
      EXPECT_EQ(capture - last_capture, GST_BUFFER_PTS(buffer.get()) - last);
    }
    last = GST_BUFFER_PTS(buffer.get());
    last_capture = capture;
  }
  const gst::EventPtr stream_start(gst_harness_pull_event(h.get()));
}

TEST(OusterFile, PointsAgreeWithTheSensorModelInTheCaps) {
  const Harness h = FromFile(kThreeScans, kThreeScansMetadata);
  const BufferPtr buffer(gst_harness_pull(h.get()));
  const CapsPtr caps(gst_pad_get_current_caps(h->sinkpad));
  const auto info = CloudInfo::FromCaps(caps.get());
  const RangeProjection projection(*info->sensor_model);
  const BufferMap map(buffer.get(), GST_MAP_READ);
  guint returns = 0;
  for (guint i = 0; i < info->Points(); ++i) {
    std::array<float, 3> xyz{};
    std::uint32_t range = 0;
    std::memcpy(xyz.data(), map.data() + i * 20, sizeof xyz);
    std::memcpy(&range, map.data() + i * 20 + 16, sizeof range);
    const auto expected = projection.Point(i / info->width, i % info->width, range);
    for (std::size_t axis = 0; axis < 3; ++axis) ASSERT_NEAR(xyz[axis], expected[axis], 1e-3);
    returns += range != 0 ? 1 : 0;
  }
  EXPECT_GT(returns, 5000U);
}

TEST(OusterFile, LoopsWithTimesThatGoOn) {
  const Harness h = FromFile("crc_test.pcap", "crc_test.json", "loop=true");
  GstClockTime last = 0;
  for (int i = 0; i < 40; ++i) {
    const BufferPtr buffer(gst_harness_pull(h.get()));
    ASSERT_TRUE(buffer);
    if (i > 0) {
      EXPECT_GE(GST_BUFFER_PTS(buffer.get()), last);
      EXPECT_LT(GST_BUFFER_PTS(buffer.get()), last + 60 * GST_MSECOND);
    }
    last = GST_BUFFER_PTS(buffer.get());
  }
  EXPECT_GT(last, 300 * GST_MSECOND);
}

TEST(OusterFile, LoopsWithoutAPauseAndWithoutAnOverlap) {
  const Harness h = FromFile(kThreeScans, kThreeScansMetadata, "loop=true");
  std::vector<GstClockTime> starts;  // of the scans
  while (starts.size() < 7) {
    const BufferPtr buffer(gst_harness_pull(h.get()));
    ASSERT_TRUE(buffer);
    GstLidarSlice slice{};
    ASSERT_TRUE(gst_lidar_buffer_get_slice(buffer.get(), &slice));
    if (slice.slice_index == 0) starts.push_back(GST_BUFFER_PTS(buffer.get()));
  }
  for (std::size_t i = 1; i < starts.size(); ++i)
    EXPECT_NEAR(static_cast<double>(starts[i] - starts[i - 1]), 1e8, 1e5) << i;
}

TEST(OusterFile, RunsAgainAfterReady) {
  const std::string launch = "ouster_src location=" + DataPath("crc_test.pcap") + " ! fakesink";
  EXPECT_EQ(RunToEnd(launch), "");
  EXPECT_EQ(RunToEnd(launch), "");
  const Harness h = FromFile(kThreeScans, kThreeScansMetadata);
  for (int round = 0; round < 3; ++round) {
    const BufferPtr buffer(gst_harness_pull(h.get()));
    GstLidarSlice slice{};
    ASSERT_TRUE(gst_lidar_buffer_get_slice(buffer.get(), &slice));
    EXPECT_EQ(slice.slice_index, 0U);
    EXPECT_EQ(GST_BUFFER_PTS(buffer.get()), 0U);
    gst_element_set_state(h->element, GST_STATE_READY);
    while (gst_harness_buffers_in_queue(h.get()) > 0)
      const BufferPtr drop(gst_harness_pull(h.get()));
    gst_element_set_state(h->element, GST_STATE_PLAYING);
  }
}

TEST(OusterFile, LivePlaybackWaitsForTheTimeOfEachPacket) {
  Harness h(gst_harness_new_parse(("ouster_src is-live=true location=" + DataPath(kThreeScans) +
                                   " metadata=" + DataPath(kThreeScansMetadata))
                                      .c_str()));
  UseTestClock(h.get());
  const auto started = static_cast<GstClockTime>(g_get_real_time()) * GST_USECOND;
  SetPlaying(h.get());
  // The packets of the capture are about 1.6 ms apart, and a slice has 8 packets.
  for (int i = 0; i < 7; ++i) {
    EXPECT_EQ(gst_harness_buffers_received(h.get()), 0U) << i;
    ASSERT_TRUE(gst_harness_crank_single_clock_wait(h.get()));
  }
  while (gst_harness_buffers_received(h.get()) == 0)
    ASSERT_TRUE(gst_harness_crank_single_clock_wait(h.get()));
  const BufferPtr buffer(gst_harness_pull(h.get()));
  const GstClockTime now =
      gst_clock_get_time(GST_CLOCK(gst_harness_get_testclock(h.get()))) - kClockStart;
  EXPECT_LT(now, 20 * GST_MSECOND);
  EXPECT_LE(GST_BUFFER_PTS(buffer.get()), now);
  EXPECT_GT(gst_lidar_buffer_get_capture_time(buffer.get()), started - 100 * GST_MSECOND)
      << "as if sampled today, a packet before it came";
  EXPECT_EQ(gst_harness_query_latency(h.get()), 12500 * GST_USECOND);
}

TEST(OusterFile, CaptureTimesAfterAPauseAreThoseOfTheDay) {
  Harness h(gst_harness_new_parse(("ouster_src is-live=true location=" + DataPath(kThreeScans) +
                                   " metadata=" + DataPath(kThreeScansMetadata))
                                      .c_str()));
  UseTestClock(h.get());
  SetPlaying(h.get());
  // The test clock does not advance during the pause, just as the running time of a pipeline does
  // not.
  const std::vector<Time> times = TimesOf(kThreeScans);
  const auto second = kClockStart + static_cast<GstClockTime>((times[1] - times[0]).count());
  ASSERT_TRUE(gst_harness_crank_single_clock_wait(h.get()));
  ASSERT_TRUE(AwaitClockWait(h.get(), second));
  gst_element_set_state(h->element, GST_STATE_PAUSED);
  const auto resumed = static_cast<GstClockTime>(g_get_real_time()) * GST_USECOND;
  gst_element_set_state(h->element, GST_STATE_PLAYING);
  while (gst_harness_buffers_received(h.get()) < 2)
    ASSERT_TRUE(gst_harness_crank_single_clock_wait(h.get()));
  const BufferPtr first(gst_harness_pull(h.get()));
  const BufferPtr next(gst_harness_pull(h.get()));
  EXPECT_GE(gst_lidar_buffer_get_capture_time(next.get()), resumed + GST_BUFFER_PTS(next.get()));
}

/// Each round begins one packet interval after the last packet of the round before it.
TEST(OusterFile, LoopsAtThePaceOfTheCapture) {
  const std::vector<Time> times = TimesOf(kThreeScans);
  const Duration round =
      times.back() - times.front() + LoadMetadata(kThreeScansMetadata).packet_interval();
  std::vector<GstClockTime> due;
  for (int n = 0; n < 3; ++n)
    for (const Time time : times) {
      const auto at = static_cast<GstClockTime>((n * round + time - times.front()).count());
      if (at > 0 && (due.empty() || due.back() < at)) due.push_back(at);
    }
  Harness h(
      gst_harness_new_parse(("ouster_src is-live=true loop=true location=" + DataPath(kThreeScans) +
                             " metadata=" + DataPath(kThreeScansMetadata))
                                .c_str()));
  UseTestClock(h.get());
  SetPlaying(h.get());
  GstClock* clock = GST_CLOCK(gst_harness_get_testclock(h.get()));
  std::vector<GstClockTime> waited;
  while (waited.size() < due.size()) {
    ASSERT_TRUE(gst_harness_crank_single_clock_wait(h.get()));
    const GstClockTime now = gst_clock_get_time(clock) - kClockStart;
    if (now > 0 && (waited.empty() || waited.back() < now)) waited.push_back(now);
    while (GstBuffer* buffer = gst_harness_try_pull(h.get())) gst_buffer_unref(buffer);
  }
  EXPECT_EQ(waited, due);
  gst_object_unref(clock);
}

TEST(OusterFile, StopsWhileItWaits) {
  Harness h(gst_harness_new_parse(("ouster_src is-live=true location=" + DataPath(kThreeScans) +
                                   " metadata=" + DataPath(kThreeScansMetadata))
                                      .c_str()));
  UseTestClock(h.get());
  SetPlaying(h.get());
  ASSERT_TRUE(gst_harness_crank_single_clock_wait(h.get()));
  EXPECT_EQ(gst_element_set_state(h->element, GST_STATE_NULL), GST_STATE_CHANGE_SUCCESS);
}

TEST(OusterFile, AddsTheFieldsThatAreAskedFor) {
  const Harness h = FromFile("OS-0-32-U1_v2.2.0_1024x10.pcap", "OS-0-32-U1_v2.2.0_1024x10.json",
                             "slices-per-scan=1 channels=ring,signal,t,near-ir return=both");
  const BufferPtr buffer(gst_harness_pull(h.get()));
  const CapsPtr caps(gst_pad_get_current_caps(h->sinkpad));
  const auto info = CloudInfo::FromCaps(caps.get());
  ASSERT_TRUE(info);
  EXPECT_EQ(info->width, 1024U);
  EXPECT_EQ(info->fields.ToString(),
            "x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,range:U32:16,range2:U32:20,"
            "intensity2:F32:24,ring:U16:28,signal:U16:30,t:U32:32,near-ir:U16:36");
  EXPECT_EQ(info->point_step, 40U);
  const BufferMap map(buffer.get(), GST_MAP_READ);
  std::uint32_t t = 0;
  std::uint16_t ring = 0;
  const std::size_t at = (std::size_t{3} * 1024 + 512) * 40;
  std::memcpy(&ring, map.data() + at + 28, sizeof ring);
  std::memcpy(&t, map.data() + at + 32, sizeof t);
  EXPECT_EQ(ring, 3U);
  EXPECT_NEAR(t, 50e6, 1e5);
}

TEST(OusterFile, FiltersByRangeAndAzimuth) {
  const Harness h = FromFile(kThreeScans, kThreeScansMetadata,
                             "min-range=2 max-range=10 azimuth-sectors=0-90 invalid=nan "
                             "slices-per-scan=1");
  const BufferPtr buffer(gst_harness_pull(h.get()));
  const BufferMap map(buffer.get(), GST_MAP_READ);
  guint kept = 0;
  for (gsize at = 0; at < map.size(); at += 20) {
    std::array<float, 3> xyz{};
    std::uint32_t range = 0;
    std::memcpy(xyz.data(), map.data() + at, sizeof xyz);
    std::memcpy(&range, map.data() + at + 16, sizeof range);
    ASSERT_EQ(std::isnan(xyz[0]), range == 0);
    if (range == 0) continue;
    ++kept;
    ASSERT_GE(range, 2000U);
    ASSERT_LE(range, 10000U);
    ASSERT_GT(xyz[0], -0.1F);
    ASSERT_GT(xyz[1], -0.1F);
  }
  EXPECT_GT(kept, 1000U);
}

TEST(OusterFile, DestaggersWholeScans) {
  const std::string scan = "slices-per-scan=1 channels=ring,t ";
  const Harness plain = FromFile(kThreeScans, kThreeScansMetadata, scan.c_str());
  const Harness shifted =
      FromFile(kThreeScans, kThreeScansMetadata, "channels=ring,t destagger=true");
  const BufferPtr a(gst_harness_pull(plain.get()));
  const BufferPtr b(gst_harness_pull(shifted.get()));
  const CapsPtr caps(gst_pad_get_current_caps(shifted->sinkpad));
  const auto info = CloudInfo::FromCaps(caps.get());
  ASSERT_TRUE(info);
  EXPECT_EQ(info->width, 1024U);
  EXPECT_FALSE(info->sensor_model);
  const ouster::Metadata metadata = LoadMetadata(kThreeScansMetadata);
  const BufferMap from(a.get(), GST_MAP_READ);
  const BufferMap to(b.get(), GST_MAP_READ);
  ASSERT_EQ(from.size(), to.size());
  const std::size_t step = info->point_step;
  for (std::size_t beam = 0; beam < 128; ++beam) {
    const auto shift = static_cast<std::size_t>(metadata.model.beams[beam].pixel_shift + 1024);
    for (std::size_t column = 0; column < 1024; ++column)
      ASSERT_EQ(std::memcmp(from.data() + (beam * 1024 + column) * step,
                            to.data() + (beam * 1024 + (column + shift) % 1024) * step, step),
                0);
  }
}

TEST(OusterFile, AScanRateThatIsNoSimpleFractionIsGivenInThousandths) {
  auto root = nlohmann::json::parse(ReadFile(DataPath(kThreeScansMetadata)));
  root["data_format"]["fps"] = 9.87654;
  const std::string path = ::testing::TempDir() + "ouster_rate.json";
  std::ofstream(path) << root;
  const Harness h(gst_harness_new_parse(
      ("ouster_src location=" + DataPath(kThreeScans) + " metadata=" + path).c_str()));
  SetPlaying(h.get());
  const BufferPtr buffer(gst_harness_pull(h.get()));
  const CapsPtr caps(gst_pad_get_current_caps(h->sinkpad));
  const auto info = CloudInfo::FromCaps(caps.get());
  ASSERT_TRUE(info);
  EXPECT_EQ(info->framerate_n, 9877);
  EXPECT_EQ(info->framerate_d, 1000);
  std::remove(path.c_str());
}

TEST(OusterFile, KeepsThePixelsThatAMaskKeeps) {
  const std::string path = ::testing::TempDir() + "ouster_mask.pgm";
  {
    std::ofstream mask(path, std::ios::binary);
    mask << "P5\n# the upper half\n1024 128\n255\n";
    mask << std::string(std::size_t{64} * 1024, '\xff')
         << std::string(std::size_t{64} * 1024, '\0');
  }
  for (const char* sectors : {"", " azimuth-sectors=0-360"}) {
    const Harness h = FromFile(kThreeScans, kThreeScansMetadata,
                               ("slices-per-scan=1 mask-location=" + path + sectors).c_str());
    const BufferPtr buffer(gst_harness_pull(h.get()));
    const BufferMap map(buffer.get(), GST_MAP_READ);
    std::array<guint, 2> returns{};
    for (gsize i = 0; i < map.size() / 20; ++i) {
      std::uint32_t range = 0;
      std::memcpy(&range, map.data() + i * 20 + 16, sizeof range);
      if (range != 0) ++returns[i / (64 * 1024)];
    }
    EXPECT_GT(returns[0], 1000U) << sectors;
    EXPECT_EQ(returns[1], 0U) << sectors;
  }
  std::remove(path.c_str());
}

TEST(OusterFile, GivesImuSamplesOnAPadOfTheirOwn) {
  const std::string path = ::testing::TempDir() + "ouster_imu.bin";
  EXPECT_EQ(RunToEnd("ouster_src name=s location=" + DataPath(kThreeScans) +
                     " metadata=" + DataPath(kThreeScansMetadata) +
                     " ! fakesink sync=false async=false  s.imu ! application/x-imu ! filesink "
                     "async=false location=" +
                     path),
            "");
  const std::string bytes = ReadFile(path);
  ASSERT_EQ(bytes.size() % 32, 0U);
  ASSERT_GE(bytes.size() / 32, 28U);
  std::uint64_t last = 0;
  for (std::size_t at = 0; at < bytes.size(); at += 32) {
    std::uint64_t t = 0;
    std::array<float, 6> v{};
    std::memcpy(&t, bytes.data() + at, sizeof t);
    std::memcpy(v.data(), bytes.data() + at + 8, sizeof v);
    if (last != 0) {
      EXPECT_NEAR(static_cast<double>(t - last), 10e6, 1e6);
    }
    last = t;
    // The acceleration is that of gravity, plus or minus the accelerations of the car.
    EXPECT_NEAR(std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]), 9.81F, 4.0F);
  }
  std::remove(path.c_str());
}

TEST(OusterFile, TheImuEndsWithTheCloudsWhateverEndsThem) {
  EXPECT_EQ(RunToEnd("ouster_src name=s num-buffers=12 loop=true location=" +
                     DataPath(kThreeScans) + " metadata=" + DataPath(kThreeScansMetadata) +
                     " ! fakesink sync=false async=false  s.imu ! fakesink async=false"),
            "");
}

}  // namespace
}  // namespace lidar::test
