// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests that Draco's coders still write the bytes of the golden files. libdraco 1.5 wrote these
// files.
#include "tests/core/codec/golden.h"

#include "ext/draco/draco_integers.h"
#include "ext/draco/xyz_codec.h"

namespace lidar::draco {
namespace {

using codec::RangeCoder;
using test::GoldenBlock;

class GoldenBytes : public ::testing::TestWithParam<GoldenBlock> {};
TEST_P(GoldenBytes, AreWhatABlockIsCodedTo) {
  test::ExpectGoldenBlock(GetParam(), GOLDEN_FOLDER, DracoIntegers::Shared());
}
INSTANTIATE_TEST_SUITE_P(
    All, GoldenBytes,
    ::testing::Values(
        GoldenBlock{"draco_turn", RangeCoder::kDraco, {8, 256, 0, 1, 10}, 41 * 256, 5},
        GoldenBlock{"draco_dense", RangeCoder::kDraco, {4, 64, 9, 1, 0}, 3 * 256 + 9, 0},
        GoldenBlock{"residual_turn", RangeCoder::kResidual, {8, 256, 0, 8, 25}, 6 * 256, 8}),
    [](const auto& c) { return c.param.name; });

TEST(GoldenXyz, IsWhatACloudIsCodedTo) {
  codec::XyzCloud cloud;
  const codec::RangeImage image = test::GoldenImage({8, 64});
  for (std::size_t i = 0; i < image.size(); ++i) {
    const auto millimetres = static_cast<float>(image.ranges[i]);
    cloud.xyz.insert(cloud.xyz.end(), {millimetres / 1024, static_cast<float>(i % 64) / 8,
                                       static_cast<float>(i / 64) / 4});
    cloud.intensity.push_back(static_cast<float>(image.intensity[i]));
  }
  for (const XyzMethod method : {XyzMethod::kSequential, XyzMethod::kKdTree}) {
    XyzSettings settings;
    settings.method = method;
    settings.level = method == XyzMethod::kSequential ? 0 : 7;
    settings.intensity_bits = 5;
    std::vector<std::uint8_t> bytes;
    XyzResult result;
    ASSERT_TRUE(EncodeXyz(cloud, settings, &bytes, &result));
    const bool tree = method == XyzMethod::kKdTree;
    test::ExpectGolden(std::string(GOLDEN_FOLDER) + (tree ? "/xyz_kd.bin" : "/xyz_sequential.bin"),
                       bytes);
    codec::XyzCloud back;
    ASSERT_TRUE(DecodeXyz({bytes.data(), bytes.size()}, 512, &back));
    ASSERT_EQ(back.size(), cloud.size());
    for (std::size_t i = 0; !tree && i < cloud.xyz.size(); ++i)
      ASSERT_NEAR(back.xyz[i], cloud.xyz[i], settings.max_error_m);
  }
}

}  // namespace
}  // namespace lidar::draco
