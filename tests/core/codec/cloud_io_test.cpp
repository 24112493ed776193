// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests the conversions between raw clouds and the clouds that the codecs code.
#include "src/codec/cloud_io.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "src/base/byte_writer.h"
#include "tests/core/codec/test_clouds.h"

namespace lidar::codec {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Returns raw bytes with the x, y, z and intensity of each point.
std::vector<std::uint8_t> RawPoints(const std::vector<std::array<float, 4>>& points) {
  std::vector<std::uint8_t> raw(points.size() * sizeof points[0]);
  std::memcpy(raw.data(), points.data(), raw.size());
  return raw;
}
XyzCloud Read(const std::vector<std::array<float, 4>>& points, bool with_intensity = true) {
  const CloudLayout layout{*PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,intensity:F32:12"), 16};
  const auto raw = RawPoints(points);
  XyzCloud cloud;
  cloud.intensity = {9};  // left from an earlier cloud
  ReadXyz({raw.data(), raw.size()}, layout, with_intensity, &cloud);
  return cloud;
}

TEST(ReadXyz, LeavesOutPointsWithACoordinateThatIsNoNumber) {
  std::vector<std::array<float, 4>> points = {{1, 2, 3, 4}};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const float bad : {kNan, kInfinity, -kInfinity}) {
      points.push_back({5, 6, 7, 8});
      points.back()[axis] = bad;
    }
  points.push_back({0, 0, 0, 8});
  points.push_back({0, 0, -1, 9});
  const XyzCloud cloud = Read(points);
  EXPECT_EQ(cloud.xyz, (std::vector<float>{1, 2, 3, 0, 0, -1}));
  EXPECT_EQ(cloud.intensity, (std::vector<float>{4, 9})) << "each its own";
  EXPECT_TRUE(Read(points, false).intensity.empty());
}

TEST(ReadRangeImage, ScalesIntensitiesByThoseOfReturns) {
  const CloudLayout layout{*PointFields::Parse("range:U32:0,intensity:F32:4"), 8};
  std::vector<std::uint8_t> raw;
  ByteWriter w(&raw);
  const auto add = [&w](std::uint32_t range_mm, float intensity) {
    w.Le32(range_mm);
    w.LeF32(intensity);
  };
  add(1000, 100);
  add(0, 60'000);
  add(2000, kInfinity);
  add(3000, kNan);
  RangeImage image;
  image.beams = 1;
  image.columns = 4;
  EXPECT_EQ(ReadRangeImage({raw.data(), raw.size()}, layout, true, &image), FullScale::kByte);
  EXPECT_EQ(image.intensity, (std::vector<std::uint8_t>{100, 0, 0, 0}));
}

TEST(ReadXyz, TakesIntensitiesThatAreNoneForZero) {
  const XyzCloud cloud = Read({{1, 1, 1, kNan}, {1, 1, 1, kInfinity}, {1, 1, 1, -3}, {1, 1, 1, 7}});
  EXPECT_EQ(cloud.intensity, (std::vector<float>{0, 0, 0, 7}));
}

class RangeClouds : public ::testing::TestWithParam<const char*> {};
TEST_P(RangeClouds, HaveNothingWhereAReturnIsMissing) {
  const SensorModel model = test::RoomSensor(4);
  RangeImage image;
  image.beams = 4;
  image.columns = 8;
  image.first_column = 500;
  image.ranges.assign(image.size(), 5'000);
  image.intensity.assign(image.size(), 200);
  for (std::size_t i = 0; i < image.size(); i += 3) image.ranges[i] = 0;
  const CloudLayout layout{*PointFields::Parse(GetParam()), 24};
  std::vector<std::uint8_t> raw(image.size() * layout.point_step, 0xEE);
  const IntensityScale scale(FullScale::kByte, 8);
  WriteRangeImage(image, scale, RangeProjection(model), layout, raw.data());
  for (std::size_t i = 0; i < image.size(); ++i) {
    const std::uint8_t* point = &raw[i * layout.point_step];
    float xyz[3], intensity = -1;
    std::uint32_t range = 1;
    std::memcpy(xyz, point + layout.fields.Find("x")->offset, sizeof xyz);
    std::memcpy(&intensity, point + layout.fields.Find("intensity")->offset, sizeof intensity);
    std::memcpy(&range, point + layout.fields.Find("range")->offset, sizeof range);
    const bool missing = i % 3 == 0;
    EXPECT_EQ(range, missing ? 0U : 5'000U) << i;
    EXPECT_FLOAT_EQ(intensity, missing ? 0 : scale.ValueOf(200)) << i;
    const float length = std::sqrt(xyz[0] * xyz[0] + xyz[1] * xyz[1] + xyz[2] * xyz[2]);
    EXPECT_NEAR(length, missing ? 0 : 5, missing ? 0 : 0.03) << i;
  }
}
INSTANTIATE_TEST_SUITE_P(
    Layouts, RangeClouds,
    ::testing::Values("x:F32:0,y:F32:4,z:F32:8,range:U32:12,intensity:F32:16",
                      "range:U32:0,x:F32:4,y:F32:8,z:F32:12,intensity:F32:16",
                      "intensity:F32:0,x:F32:8,y:F32:12,z:F32:16,range:U32:20"));

TEST(CloudFormats, HaveRangesWhereEachRowIsABeamOfTheModel) {
  CloudFormat format{test::OrganisedLayout(), 32, test::RoomSensor(32)};
  EXPECT_TRUE(format.HasRanges());
  format.height = 31;
  EXPECT_FALSE(format.HasRanges());
  format.height = 32;
  format.layout.fields = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,range:F32:12");
  EXPECT_FALSE(format.HasRanges());
  format = {test::OrganisedLayout(), 32, std::nullopt};
  EXPECT_FALSE(format.HasRanges());
}

}  // namespace
}  // namespace lidar::codec
