// SPDX-License-Identifier: LGPL-2.1-or-later
// Clouds of one row without a sensor model, whatever is in them.
#include <gtest/gtest.h>

#include <tuple>

#include "tests/elements/coders/plain_clouds.h"

namespace lidar::gst {
namespace {

/// Coders of clouds without a sensor model, and how they may be set.
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
  std::vector<float> expected;  // what is finite and not all zero
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

}  // namespace
}  // namespace lidar::gst
