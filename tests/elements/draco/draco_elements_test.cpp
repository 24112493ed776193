// SPDX-License-Identifier: LGPL-2.1-or-later
#include <glib/gstdio.h>
#include <gtest/gtest.h>

#include <map>

#include <fstream>
#include <limits>
#include <random>
#include <tuple>

#include "tests/elements/draco/draco_harness.h"

namespace lidar::gst {
namespace {

struct ErrorCase {
  const char* coder;
  std::uint32_t unit_mm;
  double max_error_m;
};
class OrganisedScans : public ::testing::TestWithParam<ErrorCase> {};

TEST_P(OrganisedScans, ComeBackWithinTheErrorSliceBySlice) {
  const ErrorCase& c = GetParam();
  const SensorModel model = test::RoomSensor(32, c.unit_mm);
  const Harness h =
      Codec("range-coder=" + std::string(c.coder) + " max-error=" + std::to_string(c.max_error_m));
  const CapsPtr caps(OrganisedInfo(model, 64).ToCaps());
  gst_harness_set_src_caps(h.get(), gst_caps_ref(caps.get()));
  for (guint i = 0; i < 8; ++i) {
    GstBuffer* input = OrganisedBuffer(model, 64, {7, i, 8, 64 * i});
    const auto before = PointsOf(input, 20);
    ASSERT_EQ(gst_harness_push(h.get(), input), GST_FLOW_OK);
    const BufferPtr output(gst_harness_pull(h.get()));
    EXPECT_LE(LargestDistance(before, PointsOf(output.get(), 20)), c.max_error_m + 1e-5);
    GstLidarSlice slice{};
    ASSERT_TRUE(gst_lidar_buffer_get_slice(output.get(), &slice));
    EXPECT_EQ(slice.scan_id, 7U);
    EXPECT_EQ(slice.slice_index, i);
    EXPECT_EQ(slice.first_column, 64 * i);
    EXPECT_EQ(GST_BUFFER_PTS(output.get()), (56 + i) * 12'500 * GST_USECOND);
    EXPECT_EQ(gst_lidar_buffer_get_capture_time(output.get()),
              1'700'000'000 * GST_SECOND + (56 + i) * 12'500 * GST_USECOND);
  }
  const CapsPtr out(gst_pad_get_current_caps(h->sinkpad));
  const auto info = CloudInfo::FromCaps(out.get());
  ASSERT_TRUE(info);
  EXPECT_EQ(info->width, 64U);
  EXPECT_EQ(info->height, 32U);
  EXPECT_EQ(info->fields, test::OrganisedLayout().fields);
  EXPECT_TRUE(info->sensor_model);
}
INSTANTIATE_TEST_SUITE_P(
    All, OrganisedScans,
    ::testing::Values(ErrorCase{"draco", 1, 0.02}, ErrorCase{"draco", 8, 0.02},
                      ErrorCase{"residual", 8, 0.05}, ErrorCase{"adaptive", 1, 0.02},
                      ErrorCase{"adaptive", 8, 0.02}, ErrorCase{"adaptive", 1, 0.0003},
                      ErrorCase{"draco", 1, 0.0015}, ErrorCase{"draco", 8, 0.001}));

TEST(DracoElements, GiveGapsBackAsZeros) {
  const SensorModel model = test::RoomSensor();
  const Harness h = Codec("");
  const CapsPtr caps(OrganisedInfo(model, 512).ToCaps());
  gst_harness_set_src_caps(h.get(), gst_caps_ref(caps.get()));
  GstBuffer* input = OrganisedBuffer(model, 512, {0, 0, 1, 0});
  const auto before = PointsOf(input, 20);
  const BufferPtr output(gst_harness_push_and_pull(h.get(), input));
  const auto after = PointsOf(output.get(), 20);
  ASSERT_EQ(after.size(), before.size());
  std::size_t gaps = 0;
  for (std::size_t i = 0; i < before.size(); i += 3) {
    const bool gap = before[i] == 0 && before[i + 1] == 0 && before[i + 2] == 0;
    gaps += gap ? 1 : 0;
    EXPECT_EQ(gap, after[i] == 0 && after[i + 1] == 0 && after[i + 2] == 0);
  }
  EXPECT_GT(gaps, 300U);
}

TEST(DracoElements, DropAndCountADamagedSliceAndGoOn) {
  const SensorModel model = test::RoomSensor();
  const Harness enc(gst_harness_new("dracoenc"));
  const Harness dec(gst_harness_new("dracodec"));
  const CapsPtr caps(OrganisedInfo(model, 64).ToCaps());
  gst_harness_set_src_caps(enc.get(), gst_caps_ref(caps.get()));
  std::vector<BufferPtr> slices;
  for (guint i = 0; i < 3; ++i) {
    slices.emplace_back(
        gst_harness_push_and_pull(enc.get(), OrganisedBuffer(model, 64, {0, i, 8, 64 * i})));
  }
  gst_harness_set_src_caps(dec.get(), gst_pad_get_current_caps(enc->sinkpad));
  BufferPtr damaged(gst_buffer_copy_deep(slices[1].get()));
  {
    BufferMap map(damaged.get(), GST_MAP_WRITE);
    map.data()[map.size() / 2] ^= 0xFF;
    map.data()[0] = 0xF0;
  }
  EXPECT_EQ(gst_harness_push(dec.get(), slices[0].release()), GST_FLOW_OK);
  EXPECT_EQ(gst_harness_push(dec.get(), damaged.release()), GST_FLOW_OK);
  EXPECT_EQ(gst_harness_push(dec.get(), slices[2].release()), GST_FLOW_OK);
  EXPECT_EQ(gst_harness_buffers_received(dec.get()), 2U);
  EXPECT_EQ(Counter(dec->element, "slices-dropped"), 1U);
  gst_buffer_unref(gst_harness_pull(dec.get()));
  const BufferPtr after(gst_harness_pull(dec.get()));
  EXPECT_TRUE(GST_BUFFER_IS_DISCONT(after.get()));
}

CloudInfo PlainInfo(guint points) {
  CloudInfo info;
  info.width = points;
  info.point_step = 16;
  info.fields = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,intensity:F32:12");
  info.framerate_n = 10;
  return info;
}

/// x, y, z and an intensity of 0.5 for each point.
GstBuffer* PlainBuffer(const std::vector<float>& xyz) {
  std::vector<float> raw;
  for (std::size_t i = 0; i + 2 < xyz.size(); i += 3)
    raw.insert(raw.end(), {xyz[i], xyz[i + 1], xyz[i + 2], 0.5F});
  GstBuffer* buffer = gst_buffer_new_memdup(raw.data(), raw.size() * sizeof(float));
  GST_BUFFER_PTS(buffer) = 0;
  GST_BUFFER_DURATION(buffer) = 100 * GST_MSECOND;
  return buffer;
}

/// Distance from each point of `a` to the nearest of `b`, the largest of them.
double LargestGap(const std::vector<float>& a, const std::vector<float>& b) {
  double largest = 0;
  for (std::size_t i = 0; i + 2 < a.size(); i += 3) {
    double nearest = 1e9;
    for (std::size_t k = 0; k + 2 < b.size(); k += 3) {
      const double x = static_cast<double>(a[i]) - static_cast<double>(b[k]);
      const double y = static_cast<double>(a[i + 1]) - static_cast<double>(b[k + 1]);
      const double z = static_cast<double>(a[i + 2]) - static_cast<double>(b[k + 2]);
      nearest = std::min(nearest, std::sqrt(x * x + y * y + z * z));
    }
    largest = std::max(largest, nearest);
  }
  return largest;
}

std::vector<float> RandomPoints(std::size_t count, float extent) {
  std::mt19937 random(11);
  std::vector<float> xyz;
  for (std::size_t i = 0; i < 3 * count; ++i)
    xyz.push_back(extent * (static_cast<float>(random() % 65'536) / 65'536 - 0.5F));
  return xyz;
}

struct PlainCase {
  const char* name;
  std::vector<float> xyz;
  std::vector<float> expected;  // what is finite and not all zero
};
class PlainClouds : public ::testing::TestWithParam<std::tuple<PlainCase, guint>> {};

TEST_P(PlainClouds, ComeBackWithinTheErrorWhateverIsInThem) {
  const auto& [cloud, level] = GetParam();
  const Harness h = Codec("geometry=xyz max-error=0.02 compression-level=" + std::to_string(level));
  const auto points = static_cast<guint>(cloud.xyz.size() / 3);
  const CapsPtr caps(PlainInfo(points).ToCaps());
  gst_harness_set_src_caps(h.get(), gst_caps_ref(caps.get()));
  ASSERT_EQ(gst_harness_push(h.get(), PlainBuffer(cloud.xyz)), GST_FLOW_OK);
  ASSERT_EQ(gst_harness_buffers_received(h.get()), cloud.expected.empty() ? 0U : 1U);
  if (cloud.expected.empty()) return;
  const BufferPtr output(gst_harness_pull(h.get()));
  const auto after = PointsOf(output.get(), 16);
  ASSERT_EQ(after.size(), cloud.expected.size());
  EXPECT_LE(LargestGap(cloud.expected, after), 0.02);
  EXPECT_LE(LargestGap(after, cloud.expected), 0.02);
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
const std::vector<float> kRandom = RandomPoints(500, 40);
const std::vector<float> kFar = {1, 2, 3, 10'000, 1, 1, 4, 5, 6};
INSTANTIATE_TEST_SUITE_P(
    All, PlainClouds,
    ::testing::Combine(
        ::testing::Values(
            PlainCase{"random", kRandom, kRandom}, PlainCase{"single", {1, 2, 3}, {1, 2, 3}},
            PlainCase{"duplicates", {1, 2, 3, 1, 2, 3}, {1, 2, 3, 1, 2, 3}},
            PlainCase{"far", kFar, kFar}, PlainCase{"zeros", {0, 0, 0, 0, 0, 0}, {}},
            PlainCase{"nan", {kNan, 0, 0, 1, 2, 3, 0, kNan, 1}, {1, 2, 3}},
            PlainCase{"infinite", {kInfinity, 0, 0, 1, 2, 3, 0, 0, -kInfinity}, {1, 2, 3}}),
        ::testing::Values(0U, 1U, 7U)),
    [](const auto& c) {
      return std::string(std::get<0>(c.param).name) + std::to_string(std::get<1>(c.param));
    });

TEST(DracoElements, GiveStockDracoFilesInXyzGeometry) {
  const StringPtr program(g_find_program_in_path("draco_decoder"));
  if (!program) GTEST_SKIP() << "draco_decoder (Debian package draco) is not installed";
  const Harness h(gst_harness_new("dracoenc"));
  const CapsPtr caps(PlainInfo(500).ToCaps());
  gst_harness_set_src_caps(h.get(), gst_caps_ref(caps.get()));
  const BufferPtr encoded(gst_harness_push_and_pull(h.get(), PlainBuffer(kRandom)));
  const BufferMap map(encoded.get(), GST_MAP_READ);
  const StringPtr folder(g_dir_make_tmp("draco-XXXXXX", nullptr));
  const std::string file = std::string(folder.get()) + "/slice.drc";
  const std::string text = std::string(folder.get()) + "/slice.obj";
  ASSERT_TRUE(g_file_set_contents(file.c_str(), reinterpret_cast<const gchar*>(map.data()),
                                  static_cast<gssize>(map.size()), nullptr));
  const std::string command = "draco_decoder -i " + file + " -o " + text;
  gint status = -1;
  ASSERT_TRUE(g_spawn_command_line_sync(command.c_str(), nullptr, nullptr, &status, nullptr));
  ASSERT_EQ(status, 0);
  std::ifstream lines(text);
  std::vector<float> points;
  for (std::string word; lines >> word;) {
    float p[3];
    if (word == "v" && lines >> p[0] >> p[1] >> p[2]) points.insert(points.end(), p, p + 3);
  }
  ASSERT_EQ(points.size(), kRandom.size());
  // The text has six digits after the point.
  EXPECT_LE(LargestGap(kRandom, points), 0.02 + 1e-5);
  g_remove(file.c_str());
  g_remove(text.c_str());
  g_rmdir(folder.get());
}

class ExtremeSettings : public ::testing::TestWithParam<const char*> {};
TEST_P(ExtremeSettings, NeverBreakTheErrorBound) {
  const SensorModel model = test::RoomSensor();
  const Harness h = Codec(GetParam());
  const CapsPtr caps(OrganisedInfo(model, 64).ToCaps());
  gst_harness_set_src_caps(h.get(), gst_caps_ref(caps.get()));
  for (guint scan = 0; scan < 3; ++scan) {
    for (guint i = 0; i < 8; ++i) {
      GstBuffer* input = OrganisedBuffer(model, 64, {scan, i, 8, 64 * i});
      const auto before = PointsOf(input, 20);
      ASSERT_EQ(gst_harness_push(h.get(), input), GST_FLOW_OK);
      const BufferPtr output(gst_harness_try_pull(h.get()));
      if (!output) continue;
      const CapsPtr out(gst_pad_get_current_caps(h->sinkpad));
      EXPECT_LE(LargestDistance(before,
                                PointsOf(output.get(), CloudInfo::FromCaps(out.get())->point_step)),
                0.02 + 1e-5);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(All, ExtremeSettings,
                         ::testing::Values("bitrate=1", "bitrate=4000000000",
                                           "quantization-step=0.0000001", "quantization-step=1000",
                                           "intensity-bits=0", "intensity-bits=1", "threads=64",
                                           "rate-model=paper bitrate=500000"));

TEST(DracoEnc, GivesTheSameCloudWithMoreThreads) {
  const SensorModel model = test::RoomSensor(128);
  std::vector<std::vector<float>> clouds;
  for (const char* settings : {"threads=1", "threads=3"}) {
    const Harness h = Codec(settings);
    const CapsPtr caps(OrganisedInfo(model, 512).ToCaps());
    gst_harness_set_src_caps(h.get(), gst_caps_ref(caps.get()));
    const BufferPtr output(
        gst_harness_push_and_pull(h.get(), OrganisedBuffer(model, 512, {0, 0, 1, 100})));
    clouds.push_back(PointsOf(output.get(), 20));
  }
  EXPECT_EQ(clouds[0], clouds[1]);
}

TEST(DracoEnc, SurvivesFlushEosAndStateCycles) {
  const SensorModel model = test::RoomSensor();
  const Harness h = Codec("");
  for (int cycle = 0; cycle < 3; ++cycle) {
    const CapsPtr caps(OrganisedInfo(model, 64).ToCaps());
    gst_harness_set_src_caps(h.get(), gst_caps_ref(caps.get()));
    const BufferPtr first(
        gst_harness_push_and_pull(h.get(), OrganisedBuffer(model, 64, {0, 0, 8, 0})));
    ASSERT_TRUE(first);
    ASSERT_TRUE(gst_harness_push_event(h.get(), gst_event_new_flush_start()));
    ASSERT_TRUE(gst_harness_push_event(h.get(), gst_event_new_flush_stop(TRUE)));
    GstSegment segment;
    gst_segment_init(&segment, GST_FORMAT_TIME);
    ASSERT_TRUE(gst_harness_push_event(h.get(), gst_event_new_segment(&segment)));
    const BufferPtr second(
        gst_harness_push_and_pull(h.get(), OrganisedBuffer(model, 64, {1, 0, 8, 0})));
    EXPECT_TRUE(GST_BUFFER_IS_DISCONT(second.get()));
    EXPECT_TRUE(gst_harness_push_event(h.get(), gst_event_new_eos()));
    ASSERT_EQ(gst_element_set_state(h->element, GST_STATE_NULL), GST_STATE_CHANGE_SUCCESS);
    gst_harness_play(h.get());
    gst_harness_push_event(h.get(), gst_event_new_stream_start("again"));
  }
}

class RefusedCaps : public ::testing::TestWithParam<std::pair<const char*, const char*>> {};
TEST_P(RefusedCaps, GiveAnErrorThatSaysWhatIsMissing) {
  const auto [launch, text] = GetParam();
  const Harness h(gst_harness_new_parse(launch));
  GstBus* bus = gst_bus_new();
  gst_element_set_bus(h->element, bus);
  gst_harness_play(h.get());
  gst_harness_push_event(h.get(), gst_event_new_stream_start("refused"));
  const CapsPtr caps(gst_caps_from_string(text));
  gst_harness_push_event(h.get(), gst_event_new_caps(caps.get()));
  const MessagePtr message(gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR));
  ASSERT_TRUE(message);
  GError* error = nullptr;
  gst_message_parse_error(message.get(), &error, nullptr);
  EXPECT_TRUE(g_error_matches(error, GST_STREAM_ERROR, GST_STREAM_ERROR_FORMAT));
  g_error_free(error);
  gst_element_set_bus(h->element, nullptr);
  gst_object_unref(bus);
}
constexpr const char* kXyzCaps =
    "application/x-pointcloud2,width=4,height=1,point-step=12,fields=(string)\"x:F32:0,y:F32:4,"
    "z:F32:8\"";
INSTANTIATE_TEST_SUITE_P(
    All, RefusedCaps,
    ::testing::Values(std::pair("dracoenc geometry=range", kXyzCaps),
                      std::pair("dracoenc",
                                "application/x-pointcloud2,width=4,point-step=4,"
                                "fields=(string)\"x:F32:0\""),
                      std::pair("dracodec",
                                "application/x-draco,geometry=(string)range,"
                                "fields=(string)\"x:F32:0,y:F32:4,z:F32:8\"")));

TEST(DracoDec, RefusesASliceOfMorePointsThanItMayHave) {
  const SensorModel model = test::RoomSensor();
  const Harness h(gst_harness_new_parse("dracoenc ! dracodec max-points=2047 name=dec"));
  const CapsPtr caps(OrganisedInfo(model, 64).ToCaps());
  gst_harness_set_src_caps(h.get(), gst_caps_ref(caps.get()));
  EXPECT_EQ(gst_harness_push(h.get(), OrganisedBuffer(model, 64, {0, 0, 8, 0})), GST_FLOW_OK);
  EXPECT_EQ(gst_harness_buffers_received(h.get()), 0U);
  const ElementPtr dec(gst_bin_get_by_name(GST_BIN(h->element), "dec"));
  EXPECT_EQ(Counter(dec.get(), "slices-dropped"), 1U);
}

TEST(DracoDec, HoldsTagsBackThroughAFlushUntilTheFirstSliceButNoGaps) {
  const SensorModel model = test::RoomSensor();
  const Harness h = Codec("");
  const CapsPtr caps(OrganisedInfo(model, 64).ToCaps());
  gst_harness_set_src_caps(h.get(), gst_caps_ref(caps.get()));
  for (guint64 i = 0; i < 100; ++i)
    gst_harness_push_event(h.get(), gst_event_new_gap(i * GST_MSECOND, GST_MSECOND));
  for (const char* title : {"first", "second"})
    gst_harness_push_event(h.get(), gst_event_new_tag(gst_tag_list_new(
                                        GST_TAG_TITLE, title, static_cast<void*>(nullptr))));
  gst_harness_push_event(h.get(), gst_event_new_flush_start());
  gst_harness_push_event(h.get(), gst_event_new_flush_stop(TRUE));
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  gst_harness_push_event(h.get(), gst_event_new_segment(&segment));
  ASSERT_EQ(gst_harness_push(h.get(), OrganisedBuffer(model, 64, {0, 0, 8, 0})), GST_FLOW_OK);
  std::map<GstEventType, int> events;
  while (const EventPtr event{gst_harness_try_pull_event(h.get())})
    ++events[GST_EVENT_TYPE(event.get())];
  EXPECT_EQ(events[GST_EVENT_GAP], 0);
  EXPECT_EQ(events[GST_EVENT_TAG], 1);
  EXPECT_EQ(events[GST_EVENT_SEGMENT], 1);
}

}  // namespace
}  // namespace lidar::gst
