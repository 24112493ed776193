// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/mixing/mixing_codec.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "src/base/crc.h"
#include "src/codec/block_memory.h"
#include "src/codec/mixing/range_part.h"
#include "src/codec/mixing/start_states.h"

namespace lidar::codec {
namespace {

SensorModel Sensor(std::uint32_t beams, std::uint32_t columns, std::uint32_t unit_mm = 1) {
  SensorModel model;
  model.columns_per_scan = columns;
  model.range_unit_mm = unit_mm;
  for (std::uint32_t i = 0; i < beams; ++i)
    model.beams.push_back({0.0, 10.0 - i, static_cast<int>(i % 4) * 3 - 4});
  return model;
}

/// Returns an image of a room with some objects, gaps and noise.
RangeImage Room(std::uint32_t beams, std::uint32_t columns, std::uint32_t unit_mm,
                std::uint32_t seed) {
  std::mt19937 random(seed);
  RangeImage image;
  image.beams = beams;
  image.columns = columns;
  for (std::uint32_t beam = 0; beam < beams; ++beam) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const double wall = 6'000 / (0.3 + std::abs(std::cos(0.02 * i + 0.1 * beam)));
      const bool thing = i / 20 % 5 == 2 && beam > 3;
      const double range = (thing ? 2'500 : wall) + static_cast<double>(random() % 30);
      const bool gap = random() % 50 == 0 || i / 30 % 7 == 3;
      const auto units = static_cast<std::uint32_t>(range) / unit_mm;
      image.ranges.push_back(gap ? 0 : units * unit_mm);
      image.intensity.push_back(static_cast<std::uint8_t>((thing ? 200 : 40) + random() % 20));
    }
  }
  return image;
}

struct Case {
  unsigned effort;
  double error_m;
  unsigned bits;
  std::uint32_t unit_mm;
  bool refined = false;
};

class MixingCodec : public testing::TestWithParam<Case> {
 protected:
  MixingSettings Settings() const {
    const Case& c = GetParam();
    MixingSettings settings{RangeGrid::ForError(c.error_m, c.unit_mm),
                            IntensityScale(FullScale::kByte, c.bits), c.effort};
    settings.refined = c.refined;
    return settings;
  }
};

/// Decodes the payload of the image. Fails the test if the payload does not decode.
RangeImage Decoded(const SensorModel& sensor, const RangeImage& image,
                   const MixingSettings& settings, const std::vector<std::uint8_t>& payload) {
  RangeImage decoded;
  decoded.beams = image.beams;
  decoded.columns = image.columns;
  MixingDecoder decoder(sensor);
  EXPECT_TRUE(decoder.Decode({payload.data(), payload.size()}, settings.grid,
                             settings.intensity.bits(), &decoded));
  return decoded;
}

TEST_P(MixingCodec, KeepsMaskBoundAndLevels) {
  const Case& c = GetParam();
  const SensorModel sensor = Sensor(16, 256, c.unit_mm);
  MixingEncoder encoder(sensor);
  // The images are a whole turn and two sectors.
  for (const std::uint32_t columns : {256U, 64U, 1U}) {
    const RangeImage image = Room(16, columns, c.unit_mm, columns);
    std::vector<std::uint8_t> payload;
    ASSERT_TRUE(encoder.Encode(image, Settings(), &payload));
    const RangeImage decoded = Decoded(sensor, image, Settings(), payload);
    ASSERT_EQ(decoded.ranges.size(), image.size());
    ASSERT_EQ(decoded.intensity.size(), c.bits > 0 ? image.size() : 0);
    for (std::size_t i = 0; i < image.size(); ++i) {
      ASSERT_EQ(decoded.ranges[i] == 0, image.ranges[i] == 0) << i;
      ASSERT_LE(std::abs(1e-3 * decoded.ranges[i] - 1e-3 * image.ranges[i]), c.error_m + 1e-9) << i;
      if (c.bits == 0 || image.ranges[i] == 0) continue;
      ASSERT_EQ(decoded.intensity[i], Settings().intensity.Coarsen(image.intensity[i])) << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Settings, MixingCodec,
                         testing::Values(Case{1, 0.02, 0, 1}, Case{2, 0.02, 0, 1},
                                         Case{3, 0.02, 0, 1}, Case{1, 0.02, 5, 8},
                                         Case{2, 0.05, 5, 8}, Case{3, 0.05, 5, 8},
                                         Case{2, 0.0001, 8, 1}, Case{3, 0.0001, 1, 1},
                                         Case{2, 0.5, 0, 1}, Case{3, 0.5, 3, 8},
                                         Case{2, 0.0001, 0, 1, true}, Case{3, 0.02, 5, 1, true},
                                         Case{2, 0.05, 8, 8, true}, Case{3, 0.5, 0, 1, true}));

TEST(MixingCodecOf, RefinedModelsAreAnotherVersion) {
  const SensorModel sensor = Sensor(16, 64);
  const RangeImage image = Room(16, 64, 1, 1);
  MixingEncoder encoder(sensor);
  const auto payload_of = [&](unsigned effort) {
    MixingSettings settings{RangeGrid(1, 41), {}, effort};
    settings.refined = true;
    std::vector<std::uint8_t> payload;
    EXPECT_TRUE(encoder.Encode(image, settings, &payload));
    return payload;
  };
  EXPECT_EQ(payload_of(1)[0] >> 4, mixing::kTableVersion);  // Effort 1 has no refined models.
  auto payload = payload_of(2);
  EXPECT_EQ(payload[0] >> 4, mixing::kRefinedVersion);
  // A decoder refuses refined models if there is a memory, or at effort 1.
  MixingDecoder decoder(sensor);
  RangeImage back = image;
  const auto memory = Remember(image, RangeGrid(1, 41), nullptr);
  EXPECT_FALSE(decoder.Decode({payload.data(), payload.size()}, RangeGrid(1, 41), 0, &back,
                              {memory->pixels.data(), &memory->model}));
  EXPECT_TRUE(decoder.Decode({payload.data(), payload.size()}, RangeGrid(1, 41), 0, &back));
  payload[0] ^= 3;  // sets effort 1
  EXPECT_FALSE(decoder.Decode({payload.data(), payload.size()}, RangeGrid(1, 41), 0, &back));
}

TEST(MixingCodecOf, ImagesWithoutGapsAndWithoutReturns) {
  const SensorModel sensor = Sensor(8, 64);
  MixingEncoder encoder(sensor);
  const MixingSettings settings{RangeGrid::ForError(0.02, 1), {}, 2};
  for (const std::uint32_t range : {0U, 5'000U}) {
    RangeImage image;
    image.beams = 8;
    image.columns = 64;
    image.ranges.assign(image.size(), range);
    std::vector<std::uint8_t> payload;
    ASSERT_TRUE(encoder.Encode(image, settings, &payload));
    EXPECT_LT(payload.size(), 24U);
    const RangeImage decoded = Decoded(sensor, image, settings, payload);
    for (const std::uint32_t r : decoded.ranges) ASSERT_NEAR(r, range, 20);
  }
}

TEST(MixingCodecOf, AnyRanges) {
  const SensorModel sensor = Sensor(8, 64);
  MixingEncoder encoder(sensor);
  std::mt19937 random(3);
  RangeImage image;
  image.beams = 8;
  image.columns = 64;
  for (std::size_t i = 0; i < image.size(); ++i)
    image.ranges.push_back(
        static_cast<std::uint32_t>(random() % mixing::kMaxBins >> random() % 26));
  for (const unsigned effort : {1U, 2U, 3U}) {
    const MixingSettings settings{RangeGrid(1, 1), {}, effort};
    std::vector<std::uint8_t> payload;
    ASSERT_TRUE(encoder.Encode(image, settings, &payload));
    EXPECT_EQ(Decoded(sensor, image, settings, payload).ranges, image.ranges);
  }
}

TEST(MixingCodecOf, RefusesWhatDoesNotFit) {
  MixingEncoder encoder(Sensor(8, 64));
  std::vector<std::uint8_t> payload;
  RangeImage image = Room(8, 64, 1, 1);
  image.ranges[5] = mixing::kMaxBins;
  EXPECT_FALSE(encoder.Encode(image, {RangeGrid(1, 1), {}, 2}, &payload));
  EXPECT_FALSE(encoder.Encode(Room(4, 64, 1, 1), {RangeGrid(1, 41), {}, 2}, &payload));
  EXPECT_FALSE(encoder.Encode(Room(8, 65, 1, 1), {RangeGrid(1, 41), {}, 2}, &payload));
  EXPECT_TRUE(payload.empty());
}

/// Returns a payload in which each bit has the value that the decoder expects. Such bits take
/// nearly no bytes, so the payload could fill an image of any size.
std::vector<std::uint8_t> AsExpected(std::size_t bytes) {
  std::vector<std::uint8_t> payload(bytes, 0xFF);
  payload[0] = mixing::kTableVersion << 4 | 4 | 3;  // the version, a flag for gaps, effort 3
  return payload;
}

TEST(MixingCodecOf, WorkIsBoundedByTheBytes) {
  const SensorModel sensor = Sensor(128, 8'192);
  MixingDecoder decoder(sensor);
  for (const std::size_t bytes : {4U, 60U, 1'400U}) {
    const auto payload = AsExpected(bytes);
    RangeImage image;
    image.beams = 128;
    const std::size_t most = MostMixedPixels(bytes) / image.beams;
    // The decoder refuses an image with more pixels before it allocates memory for them.
    image.columns = static_cast<std::uint32_t>(most + 1);
    EXPECT_FALSE(decoder.Decode({payload.data(), bytes}, RangeGrid(1, 41), 0, &image));
    EXPECT_EQ(image.ranges.capacity(), 0U);
  }
  // These are few of the 1,048,576 pixels that a decoder accepts by default.
  EXPECT_LE(MostMixedPixels(60), 20'000U);
}

TEST(MixingCodecOf, AReturnIsNeverAtTheSensor) {
  const SensorModel sensor = Sensor(4, 16);
  MixingDecoder decoder(sensor);
  RangeImage image;
  image.beams = 4;
  image.columns = 16;
  for (std::size_t bytes = 2; bytes < 40; ++bytes) {
    auto payload = AsExpected(bytes);
    payload[0] = mixing::kTableVersion << 4 | 3;  // Without gaps, each pixel gets the bin 0.
    EXPECT_FALSE(decoder.Decode({payload.data(), bytes}, RangeGrid(1, 1), 0, &image)) << bytes;
  }
}

TEST(MixingCodecOf, AnEncoderLeavesWhatIsTooSmallToOthers) {
  const SensorModel sensor = Sensor(32, 512);
  const MixingSettings settings{RangeGrid(1, 41), {}, 3};
  RangeImage sky;
  sky.beams = 32;
  std::vector<std::uint8_t> payload;
  MixingEncoder encoder(sensor);
  for (const std::uint32_t columns : {128U, 512U}) {
    sky.columns = columns;
    sky.ranges.assign(sky.size(), 0);
    EXPECT_EQ(encoder.Encode(sky, settings, &payload), columns == 128) << columns;
    EXPECT_EQ(payload.empty(), columns != 128);
    payload.clear();
  }
}

TEST(MixingCodecOf, DependsOnNoSliceBefore) {
  const SensorModel sensor = Sensor(16, 256);
  const MixingSettings settings{RangeGrid::ForError(0.02, 1), IntensityScale(FullScale::kByte, 5),
                                2};
  MixingEncoder encoder(sensor);
  const RangeImage image = Room(16, 128, 1, 1);
  std::vector<std::uint8_t> first;
  encoder.Encode(image, settings, &first);
  std::vector<std::uint8_t> other;
  encoder.Encode(Room(16, 256, 1, 2), settings, &other);
  std::vector<std::uint8_t> again;
  encoder.Encode(image, settings, &again);
  EXPECT_EQ(first, again);
}

TEST(MixingCodecOf, DamagedPayloadsGiveAnImageOrNothing) {
  const SensorModel sensor = Sensor(16, 64);
  const MixingSettings settings{RangeGrid::ForError(0.02, 1), IntensityScale(FullScale::kByte, 5),
                                2};
  MixingEncoder encoder(sensor);
  const RangeImage image = Room(16, 64, 1, 1);
  std::vector<std::uint8_t> payload;
  encoder.Encode(image, settings, &payload);
  MixingDecoder decoder(sensor);
  RangeImage decoded = image;
  const auto decode = [&](const std::vector<std::uint8_t>& bytes) {
    return decoder.Decode({bytes.data(), bytes.size()}, settings.grid, 5, &decoded);
  };
  for (std::size_t size = 0; size < payload.size() - 1; size += 7)
    EXPECT_FALSE(decode({payload.begin(), payload.begin() + static_cast<std::ptrdiff_t>(size)}));
  std::mt19937 random(5);
  int accepted = 0;
  for (int i = 0; i < 200; ++i) {
    auto damaged = payload;
    damaged[random() % damaged.size()] ^= static_cast<std::uint8_t>(1U << random() % 8);
    accepted += decode(damaged) ? 1 : 0;
  }
  // The decoder does not notice all damage. The CRC of the payload format finds the rest.
  EXPECT_LT(accepted, 20);
  EXPECT_TRUE(decode(payload));
}

/// Returns an image that is computed with integers only, so that it is the same on each machine.
RangeImage Steps() {
  RangeImage image;
  image.beams = 16;
  image.columns = 256;
  std::uint32_t noise = 1;
  for (std::uint32_t i = 0; i < 16 * 256; ++i) {
    noise = noise * 1'664'525 + 1'013'904'223;
    const std::uint32_t range = 3'000 + i % 256 / 20 * 700 + i / 256 * 40 + (noise >> 27);
    image.ranges.push_back(noise >> 20 & 15 ? range : 0);
    image.intensity.push_back(static_cast<std::uint8_t>(40 * (i / 30 % 4) + (noise >> 28)));
  }
  return image;
}

TEST(MixingFormat, IsTheSameWithEveryCompilerAndProcessor) {
  // If these numbers change, the format needs a new version.
  const std::array<std::uint32_t, 3> expected = {2'862'675'178, 3'885'110'784, 3'935'255'924};
  MixingEncoder encoder(Sensor(16, 256));
  for (unsigned effort = 1; effort <= 3; ++effort) {
    std::vector<std::uint8_t> payload;
    ASSERT_TRUE(encoder.Encode(
        Steps(), {RangeGrid(1, 41), IntensityScale(FullScale::kByte, 5), effort}, &payload));
    EXPECT_EQ(Crc32({payload.data(), payload.size()}), expected[effort - 1]) << effort;
  }
}

TEST(MixingFormat, IsTheSameWhereNearlyNothingIsNew) {
  // With nearly equal pixels, spreads and counters reach their limits.
  RangeImage wall;
  wall.beams = 16;
  wall.columns = 512;
  for (std::uint32_t i = 0; i < 16 * 512; ++i) {
    wall.ranges.push_back(i % 701 == 700 ? 5'300 : 5'000 + i % 997 / 996 * 45);
    wall.intensity.push_back(static_cast<std::uint8_t>(i % 503 == 0 ? 90 : 40));
  }
  const std::array<std::uint32_t, 3> expected = {706'935'441, 4'266'764'020, 2'219'435'647};
  MixingEncoder encoder(Sensor(16, 512));
  for (unsigned effort = 1; effort <= 3; ++effort) {
    std::vector<std::uint8_t> payload;
    ASSERT_TRUE(encoder.Encode(
        wall, {RangeGrid(1, 41), IntensityScale(FullScale::kByte, 5), effort}, &payload));
    EXPECT_EQ(Crc32({payload.data(), payload.size()}), expected[effort - 1]) << effort;
  }
}

TEST(MixingTable, ComesBackAsItWasWritten) {
  const std::vector<std::uint8_t> table = mixing::CommittedTable();
  ASSERT_GT(table.size(), 1'000U);
  const auto states = std::make_unique<mixing::StartStates>();
  ASSERT_TRUE(states->Read({table.data(), table.size()}));
  std::vector<std::uint8_t> again;
  states->Write(&again);
  EXPECT_EQ(again, table);
  EXPECT_FALSE(states->Read({table.data(), table.size() - 8}));
}

}  // namespace
}  // namespace lidar::codec
