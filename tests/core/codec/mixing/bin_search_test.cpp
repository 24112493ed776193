// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests the choice between bins: that it saves bits, and that it keeps the error.
#include <gtest/gtest.h>

#include <map>
#include <memory>

#include "src/base/crc.h"
#include "src/codec/mixing/mixing_codec.h"
#include "src/codec/mixing/range_part.h"
#include "src/codec/mixing/start_states.h"
#include "src/codec/range_codec.h"
#include "tests/core/codec/test_clouds.h"

namespace lidar::codec {
namespace {

constexpr std::uint32_t kErrorMm = 50;
const RangeGrid kCoarse(1, 101);
const RangeGrid kFine(1, 67);

MixingSettings Searching(unsigned bits = 0) {
  MixingSettings settings{kFine, IntensityScale(FullScale::kByte, bits), 3};
  settings.error_mm = kErrorMm;
  return settings;
}

std::vector<std::uint8_t> PayloadOf(const SensorModel& model, const RangeImage& image,
                                    const MixingSettings& settings) {
  MixingEncoder encoder(model);
  std::vector<std::uint8_t> payload;
  EXPECT_TRUE(encoder.Encode(image, settings, &payload));
  return payload;
}

/// Counts the pixels that are a gap in only one of the images, or whose ranges differ by more than
/// `error_mm`.
std::size_t Wrong(const RangeImage& image, const RangeImage& back, std::uint32_t error_mm) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const std::int64_t d = std::int64_t{image.ranges[i]} - back.ranges[i];
    const bool same_kind = (image.ranges[i] == 0) == (back.ranges[i] == 0);
    wrong += same_kind && std::abs(d) <= error_mm ? 0U : 1U;
  }
  return wrong;
}

struct AllOpinions {
  static constexpr unsigned kRangeContexts = mixing::kRangeContexts.size();
  static constexpr unsigned kCentres = mixing::kCentres;
  static constexpr unsigned kCandidates = mixing::kCandidates;
  static constexpr bool kEvents = true;
  static constexpr bool kRefined = false;
};

TEST(BinSearch, CostsAreTheSameInAnyOrderOfBins) {
  const auto model = std::make_unique<mixing::Model>();
  mixing::Trained().CopyTo(3, 50, 0, model.get());
  mixing::CostMeter meter;
  mixing::RangePart<AllOpinions, mixing::CostMeter> part(model.get(), &meter, 50);
  // The row above the coded row shows a wall, and then a pole.
  std::vector<mixing::Azimuth> above(24);
  std::vector<std::int32_t> north(24);
  for (std::size_t i = 0; i < above.size(); ++i) {
    const std::int32_t value = mixing::CentreOf(i < 12 ? 100 : 60);
    above[i].values = {value, value, value};
    north[i] = value;
  }
  part.StartRow(&above[8], &north[8]);
  for (std::uint32_t i = 0; i < 3; ++i) {
    part.Consider(i);
    part.See(i == 1 ? 90 : 101, &above[8 + i]);
  }
  const auto start = part.row();
  const auto costs_of = [&](std::vector<std::int32_t> bins) {
    std::map<std::int32_t, std::int32_t> costs;
    part.Resume(start);
    part.Consider(3);
    for (const std::int32_t bin : bins) {
      costs[bin] = part.CostOf(bin, INT64_MAX);
      mixing::Azimuth azimuth = above[11];
      part.Resume(start);
      part.See(bin, &azimuth);
    }
    return costs;
  };
  EXPECT_EQ(costs_of({80, 90, 101, 120}), costs_of({120, 101, 90, 80}));
}

TEST(BinSearch, SavesBitsWithinTheSameError) {
  const SensorModel model = test::RoomSensor();
  for (const std::uint32_t columns : {128U, 1U}) {
    const RangeImage image = test::RoomScan(model, 0, columns);
    const auto plain = PayloadOf(model, image, {kCoarse, {}, 3});
    const auto searched = PayloadOf(model, image, Searching());
    if (columns > 1) {
      EXPECT_LT(20 * searched.size(), 19 * plain.size());
    }
    RangeImage back;
    back.beams = image.beams;
    back.columns = columns;
    MixingDecoder decoder(model);
    ASSERT_TRUE(decoder.Decode({searched.data(), searched.size()}, kFine, 0, &back));
    EXPECT_EQ(Wrong(image, back, kErrorMm), 0U);
    EXPECT_EQ(decoder.error_mm(), kErrorMm);
    ASSERT_TRUE(decoder.Decode({plain.data(), plain.size()}, kCoarse, 0, &back));
    EXPECT_EQ(decoder.error_mm(), 0U);
  }
}

TEST(BinSearch, KeepsRangesNextToTheSensorAndFarAway) {
  const SensorModel model = test::RoomSensor();
  RangeImage image = test::RoomScan(model, 0, 128);
  for (std::uint32_t i = 0; i < image.size(); i += 173)
    image.ranges[i] = i % 2 == 0 ? 1 + i % 90 : 1'000'000 + 3 * i % 997;
  const auto payload = PayloadOf(model, image, Searching());
  RangeImage back = image;
  MixingDecoder decoder(model);
  ASSERT_TRUE(decoder.Decode({payload.data(), payload.size()}, kFine, 0, &back));
  EXPECT_EQ(Wrong(image, back, kErrorMm), 0U);
}

/// A bin after the last one would be within the error, but decoders refuse such a bin.
TEST(BinSearch, KeepsToTheBinsThatDecodersTake) {
  const SensorModel model = test::RoomSensor();
  RangeImage image = test::RoomScan(model, 0, 128);
  const std::size_t half = image.size() / 2;
  for (std::size_t i = half; i < image.size(); ++i)
    image.ranges[i] = RangeGrid::kMaxRangeMm - static_cast<std::uint32_t>(i / 7 % 5);
  MixingSettings settings{RangeGrid(1, 27), IntensityScale(FullScale::kByte, 0), 3};
  settings.error_mm = 20;
  const auto payload = PayloadOf(model, image, settings);
  RangeImage back = image;
  MixingDecoder decoder(model);
  ASSERT_TRUE(decoder.Decode({payload.data(), payload.size()}, settings.grid, 0, &back));
  EXPECT_EQ(Wrong(image, back, settings.error_mm), 0U);
}

TEST(BinSearch, IsTakenWhereItSavesAndToldToTheReceiver) {
  const SensorModel model = test::RoomSensor();
  const RangeImage image = test::RoomScan(model, 0, 128);
  RangeEncoder encoder(model);
  RangeDecoder decoder(model);
  RangeSettings settings;
  settings.coder = RangeCoder::kMixing;
  settings.effort = 3;
  settings.intensity = IntensityScale(FullScale::kByte, 5);
  for (const std::uint32_t cells : {101U, 1U}) {
    settings.grid = RangeGrid(1, cells);
    std::vector<std::uint8_t> bytes;
    ASSERT_TRUE(encoder.Encode(image, settings, &bytes));
    ByteReader reader(bytes.data(), bytes.size());
    RangeImage back;
    IntensityScale scale;
    ASSERT_TRUE(decoder.Decode(&reader, 1U << 20, &back, &scale));
    EXPECT_EQ(decoder.header().grid.parts() < settings.grid.parts(), cells > 1);
    EXPECT_EQ(decoder.error_m(), settings.grid.error_m());
    EXPECT_EQ(Wrong(image, back, cells / 2), 0U);
    const auto plain = PayloadOf(model, image, {settings.grid, settings.intensity, 3});
    EXPECT_EQ(bytes.size() < plain.size(), cells > 1);
  }
}

TEST(BinSearch, LeavesRoughScenesAlone) {
  const SensorModel model = test::RoomSensor();
  RangeImage image = test::RoomScan(model, 0, 128);
  std::mt19937 random(3);
  for (std::uint32_t& range : image.ranges)
    if (range != 0) range = 1'000 + static_cast<std::uint32_t>(random() % 20'000);
  RangeSettings settings;
  settings.coder = RangeCoder::kMixing;
  settings.effort = 3;
  settings.grid = kCoarse;
  std::vector<std::uint8_t> bytes;
  ASSERT_TRUE(RangeEncoder(model).Encode(image, settings, &bytes));
  ByteReader reader(bytes.data(), bytes.size());
  RangeDecoder decoder(model);
  RangeImage back;
  IntensityScale scale;
  ASSERT_TRUE(decoder.Decode(&reader, image.size(), &back, &scale));
  EXPECT_EQ(decoder.header().grid.parts(), kCoarse.parts());
  EXPECT_EQ(Wrong(image, back, kErrorMm), 0U);
}

TEST(BinSearch, RefusesAnErrorThatIsNone) {
  const SensorModel model = test::RoomSensor();
  const RangeImage image = test::RoomScan(model, 0, 64);
  std::vector<std::uint8_t> payload = PayloadOf(model, image, Searching());
  RangeImage back = image;
  MixingDecoder decoder(model);
  ASSERT_EQ(payload[1], kErrorMm);
  payload[1] = 0;
  EXPECT_FALSE(decoder.Decode({payload.data(), payload.size()}, kFine, 0, &back));
  EXPECT_FALSE(decoder.Decode({payload.data(), 1}, kFine, 0, &back));
  payload.assign({payload[0], 0x80, 0x80, 0x80, 0x80, 0x01, 0, 0, 0});
  EXPECT_FALSE(decoder.Decode({payload.data(), payload.size()}, kFine, 0, &back));
}

TEST(BinSearch, IsTheSameWithEveryCompilerAndProcessor) {
  RangeImage image;
  image.beams = 32;
  image.columns = 128;
  std::uint32_t noise = 1;
  for (std::uint32_t i = 0; i < image.size(); ++i) {
    noise = noise * 1'664'525 + 1'013'904'223;
    image.ranges.push_back(3'000 + i % 128 / 20 * 700 + i % 20 * 13 + i / 128 * 40 + (noise >> 27));
    image.intensity.push_back(static_cast<std::uint8_t>(40 * (i / 30 % 4) + (noise >> 28)));
  }
  const auto payload = PayloadOf(test::RoomSensor(), image, Searching(5));
  EXPECT_EQ(Crc32({payload.data(), payload.size()}), 1'109'107'181U);
}

}  // namespace
}  // namespace lidar::codec
