// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests with clouds that have one row and no sensor model. Their points may have any values.
#include <gtest/gtest.h>

#include <tuple>

#include "tests/elements/coders/plain_clouds.h"

namespace lidar::gst {
namespace {

/// Returns the coders of clouds without a sensor model, with several settings.
std::vector<CoderCase> XyzCoders() {
  return {
      {"lidar_effort_0", "lidarenc effort=0", "lidardec", true},
      {"lidar_effort_3", "lidarenc effort=3", "lidardec", true},
#ifdef HAVE_DRACO
      {"draco_level_0", "dracoenc compression-level=0", "dracodec", true},
      {"draco_level_1", "dracoenc compression-level=1", "dracodec", true},
      {"draco_level_7", "dracoenc compression-level=7", "dracodec", true},
#endif
  };
}

struct PlainCase {
  const char* name;
  std::vector<float> xyz;
  std::vector<float> expected;  // the points that are finite and not all zero
};
class PlainClouds : public ::testing::TestWithParam<std::tuple<PlainCase, CoderCase>> {};

TEST_P(PlainClouds, ComeBackWithinTheErrorWhateverIsInThem) {
  const auto& [cloud, coder] = GetParam();
  const Harness h = Codec(coder, "max-error=0.02");
  const auto points = static_cast<guint>(cloud.xyz.size() / 3);
  SetCaps(h.get(), XyzInfo(points));
  ASSERT_EQ(gst_harness_push(h.get(), PlainBuffer(cloud.xyz)), GST_FLOW_OK);
  ASSERT_EQ(gst_harness_buffers_received(h.get()), cloud.expected.empty() ? 0U : 1U);
  if (cloud.expected.empty()) return;
  const BufferPtr output(gst_harness_pull(h.get()));
  const auto after = PointsOf(output.get(), 16);
  ASSERT_EQ(after.size(), cloud.expected.size());
  EXPECT_LE(LargestGap(cloud.expected, after), 0.02);
  EXPECT_LE(LargestGap(after, cloud.expected), 0.02);
}

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
        ::testing::ValuesIn(XyzCoders())),
    [](const auto& c) {
      return std::string(std::get<0>(c.param).name) + "_" + std::get<1>(c.param).name;
    });

class SizesOfClouds : public ::testing::TestWithParam<CoderCase> {};
TEST_P(SizesOfClouds, DoNotChangeTheCapsOfSlices) {
  const Harness h = Encoder(GetParam());
  unsigned caps = 0;
  for (const guint points : {100U, 200U, 100U}) {
    SetCaps(h.get(), XyzInfo(points));
    ASSERT_EQ(gst_harness_push(h.get(), PlainBuffer(RandomPoints(points, 40))), GST_FLOW_OK);
    while (const EventPtr event{gst_harness_try_pull_event(h.get())})
      caps += GST_EVENT_TYPE(event.get()) == GST_EVENT_CAPS ? 1U : 0U;
  }
  EXPECT_EQ(caps, 1U) << "each time costs elements downstream a negotiation";
}
INSTANTIATE_TEST_SUITE_P(All, SizesOfClouds, ::testing::ValuesIn(XyzCoders()),
                         [](const auto& coder) { return coder.param.name; });

class DriverFields : public ::testing::TestWithParam<CoderCase> {};

// The rings jump and are larger than 65,535, and the timestamps decrease.
TEST_P(DriverFields, AreNeitherNeededNorBelieved) {
  const Harness h = Codec(GetParam(), "max-error=0.02");
  const std::vector<float> xyz = RandomPoints(500, 40);
  const std::size_t points = xyz.size() / 3;
  CloudInfo info = XyzInfo(static_cast<guint>(points));
  info.point_step = 32;
  info.fields =
      *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,ring:U32:16,timestamp:F64:24");
  SetCaps(h.get(), info);
  std::vector<std::uint8_t> raw(32 * points);
  for (std::size_t i = 0; i < points; ++i) {
    const auto ring = static_cast<std::uint32_t>(i * 2'654'435'761U);
    const double time = -1e9 * static_cast<double>(i);
    std::memcpy(&raw[32 * i], &xyz[3 * i], 12);
    std::memcpy(&raw[32 * i + 16], &ring, sizeof ring);
    std::memcpy(&raw[32 * i + 24], &time, sizeof time);
  }
  GstBuffer* buffer = gst_buffer_new_memdup(raw.data(), raw.size());
  GST_BUFFER_PTS(buffer) = 0;
  ASSERT_EQ(gst_harness_push(h.get(), buffer), GST_FLOW_OK);
  const BufferPtr output(gst_harness_try_pull(h.get()));
  ASSERT_TRUE(output);
  const auto after = PointsOf(output.get(), 16);
  EXPECT_EQ(after.size(), xyz.size());
  EXPECT_LE(LargestGap(xyz, after), 0.02);
}

// The second cloud has other fields and fewer points, as from another sensor.
TEST_P(DriverFields, MayChangeWhileTheStreamRuns) {
  const Harness h = Codec(GetParam(), "max-error=0.02");
  for (const std::size_t points : {500U, 80U, 500U}) {
    const std::vector<float> xyz = RandomPoints(points, 40);
    CloudInfo info = XyzInfo(static_cast<guint>(points));
    if (points == 80) info.fields = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8");
    SetCaps(h.get(), info);
    ASSERT_EQ(gst_harness_push(h.get(), PlainBuffer(xyz)), GST_FLOW_OK);
    const BufferPtr output(gst_harness_try_pull(h.get()));
    ASSERT_TRUE(output);
    EXPECT_LE(LargestGap(xyz, PointsOf(output.get(), points == 80 ? 12 : 16)), 0.02);
  }
}
INSTANTIATE_TEST_SUITE_P(All, DriverFields, ::testing::ValuesIn(XyzCoders()),
                         [](const auto& c) { return std::string(c.param.name); });

/// Returns the points that a sensor with 16 beams sees of a room in the first `firings` of 450
/// firings.
std::vector<float> SpinningScan(int firings) {
  std::vector<float> xyz;
  for (int firing = 0; firing < firings; ++firing) {
    for (int beam = 0; beam < 16; ++beam) {
      const double azimuth = firing * 0.8 * M_PI / 180;
      const double rho =
          std::min(10 / std::abs(std::cos(azimuth)), 6 / std::abs(std::sin(azimuth)));
      xyz.push_back(static_cast<float>(rho * std::cos(azimuth)));
      xyz.push_back(static_cast<float>(rho * std::sin(azimuth)));
      xyz.push_back(static_cast<float>(rho * std::tan((2.0 * beam - 15) * M_PI / 180)));
    }
  }
  return xyz;
}

/// Codes the clouds in order. Returns true if the last cloud was coded by beams.
bool ComesFromBeams(const std::vector<std::vector<float>>& clouds) {
  const Harness h = Launch("lidarenc effort=1 max-error=0.02");
  bool has_beams = false;
  for (const std::vector<float>& xyz : clouds) {
    SetCaps(h.get(), XyzInfo(static_cast<guint>(xyz.size() / 3)));
    EXPECT_EQ(gst_harness_push(h.get(), PlainBuffer(xyz)), GST_FLOW_OK);
    const BufferPtr slice(gst_harness_pull(h.get()));
    const BufferMap map(slice.get(), GST_MAP_READ);
    has_beams = (map.data()[0] & 16) != 0;  // flag in docs/cloud-coder.md
  }
  return has_beams;
}

// Drivers leave out missing returns. Therefore each cloud has a different size, and different caps.
TEST(LidarEnc, KnowsASensorWhoseCloudsChangeInSize) {
  EXPECT_TRUE(ComesFromBeams({SpinningScan(450)}));
  EXPECT_FALSE(ComesFromBeams({SpinningScan(6)}));
  EXPECT_TRUE(ComesFromBeams({SpinningScan(450), SpinningScan(6)}));
}

class StoppedSink : public ::testing::TestWithParam<CoderCase> {};

// When a pipeline stops, its elements stop one after another, beginning with the sink. Upstream
// elements may still push meanwhile.
TEST_P(StoppedSink, IsNoError) {
  const Harness h = Codec(GetParam(), "max-error=0.02");
  SetCaps(h.get(), XyzInfo(500));
  gst_pad_set_active(h->sinkpad, FALSE);
  EXPECT_EQ(gst_harness_push(h.get(), PlainBuffer(RandomPoints(500, 40))), GST_FLOW_FLUSHING);
}
INSTANTIATE_TEST_SUITE_P(All, StoppedSink, ::testing::ValuesIn(XyzCoders()),
                         [](const auto& c) { return std::string(c.param.name); });

}  // namespace
}  // namespace lidar::gst
