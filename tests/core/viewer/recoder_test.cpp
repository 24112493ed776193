// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/viewer/recoder.h"

#include <gtest/gtest.h>

#include "tests/core/codec/test_clouds.h"

namespace lidar::viewer {
namespace {

codec::CloudFormat RoomFormat() {
  const SensorModel model = test::RoomSensor();
  return {test::OrganisedLayout(), static_cast<std::uint32_t>(model.beams.size()), model};
}

/// A sector of a room that was decoded.
struct Sector {
  codec::CloudFormat format = RoomFormat();
  codec::RangeImage image = test::RoomScan(*format.sensor_model, 64, 64);
  std::vector<std::uint8_t> points;
  Recoder::Decoded decoded;

  Sector() {
    const RangeProjection projection(*format.sensor_model);
    points.resize(image.size() * format.layout.point_step);
    codec::WriteRangeImage(image, {}, projection, format.layout, points.data());
    decoded.points = {points.data(), points.size()};
    decoded.shape = {image.columns, image.beams, image.first_column, false};
    decoded.quality.step_m = 0.041;
  }
};

TEST(Recoder, MakesSlicesThatStandAlone) {
  Sector sector;
  sector.decoded.coded_size = 100'000;
  auto recoder = Recoder::Create(sector.format);
  ASSERT_TRUE(recoder);
  std::vector<std::uint8_t> bytes;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(recoder->Encode(sector.decoded, &bytes));
    codec::SliceDecoder decoder(sector.format, 1U << 20);
    const auto shape = decoder.Decode({bytes.data(), bytes.size()});
    ASSERT_TRUE(shape);
    EXPECT_EQ(shape->first_column, 64U);
    EXPECT_NEAR(decoder.quality().step_m, 0.041, 1e-4);
  }
  EXPECT_EQ(recoder->coarseness(), 1);
}

TEST(Recoder, KeepsAsManyBitsOfIntensityAsTheRobot) {
  Sector sector;
  sector.decoded.coded_size = 100'000;
  sector.decoded.quality.intensity_bits = 5;
  auto recoder = Recoder::Create(sector.format);
  std::vector<std::uint8_t> bytes;
  ASSERT_TRUE(recoder->Encode(sector.decoded, &bytes));
  codec::SliceDecoder decoder(sector.format, 1U << 20);
  ASSERT_TRUE(decoder.Decode({bytes.data(), bytes.size()}));
  EXPECT_EQ(decoder.quality().intensity_bits, 5U);
}

TEST(Recoder, GetsCoarserUntilItsSlicesAreAsSmallAsTheRobots) {
  Sector sector;
  auto recoder = Recoder::Create(sector.format);
  std::vector<std::uint8_t> bytes;
  sector.decoded.coded_size = 1'000'000;
  recoder->Encode(sector.decoded, &bytes);
  const std::size_t alone = bytes.size();
  sector.decoded.coded_size = alone * 6 / 10;
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(recoder->Encode(sector.decoded, &bytes));
  EXPECT_LT(bytes.size(), alone * 66 / 100);
  EXPECT_GT(recoder->coarseness(), 1.5);
  sector.decoded.coded_size = 2 * alone;
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(recoder->Encode(sector.decoded, &bytes));
  EXPECT_EQ(recoder->coarseness(), 1);
}

TEST(Recoder, IsForCloudsWithRanges) {
  codec::CloudFormat format = RoomFormat();
  format.sensor_model.reset();
  EXPECT_FALSE(Recoder::Create(format));
}

}  // namespace
}  // namespace lidar::viewer
