// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests that slices of earlier encoders still decode to the same clouds.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "src/codec/cloud/cloud_decoder.h"

namespace lidar::codec::cloud {
namespace {

struct GoldenCloud {
  const char* name;
  std::size_t points;
  std::size_t intensities;
  std::array<double, 3> sums;  // the sums of all x, all y and all z
};
std::ostream& operator<<(std::ostream& out, const GoldenCloud& g) { return out << g.name; }

class GoldenClouds : public ::testing::TestWithParam<GoldenCloud> {};
TEST_P(GoldenClouds, AreReadForEver) {
  const GoldenCloud& golden = GetParam();
  std::ifstream file(GOLDEN_CLOUDS_FOLDER "/" + std::string(golden.name) + ".bin",
                     std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  CloudDecoder decoder(1U << 20);
  ASSERT_TRUE(decoder.Decode({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}));
  const XyzCloud& cloud = decoder.cloud();
  EXPECT_EQ(cloud.size(), golden.points);
  EXPECT_EQ(cloud.intensity.size(), golden.intensities);
  std::array<double, 3> sums{};
  for (std::size_t i = 0; i < cloud.xyz.size(); ++i)
    sums[i % 3] += static_cast<double>(cloud.xyz[i]);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(sums[k], golden.sums[k], 0.02);
}
INSTANTIATE_TEST_SUITE_P(
    All, GoldenClouds,
    ::testing::Values(GoldenCloud{"beams_coded", 6000, 0, {23805.19, 71168.90, 903.15}},
                      GoldenCloud{"beams_jitter", 7782, 0, {-225.14, -211.67, -88.95}},
                      GoldenCloud{"beams_levels", 4000, 4000, {-1419.93, 19310.99, -40.89}},
                      GoldenCloud{"beams_sides", 6000, 0, {23805.19, 71168.90, 903.15}},
                      GoldenCloud{"beams_swings", 14384, 0, {-8010.21, 614.27, 0.02}},
                      GoldenCloud{"bends", 7200, 0, {79558.06, -145.63, 6181.37}},
                      GoldenCloud{"extras", 2000, 2000, {11693.06, 10103.61, -42.61}},
                      GoldenCloud{"near", 700, 700, {841.18, 773.62, 169.34}},
                      GoldenCloud{"path", 8000, 0, {1590.64, -1672.08, -28151.94}},
                      GoldenCloud{"refined", 2665, 0, {-63.65, -120.89, -13.62}},
                      GoldenCloud{"sparse", 2743, 0, {51495.50, 13097.82, -529.16}}),
    [](const auto& golden) { return std::string(golden.param.name); });

}  // namespace
}  // namespace lidar::codec::cloud
