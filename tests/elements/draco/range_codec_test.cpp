// SPDX-License-Identifier: LGPL-2.1-or-later
#include "draco/codec/range_codec.h"

#include <gtest/gtest.h>

#include <random>

#include "test_clouds.h"

namespace lidar::codec {
namespace {

constexpr std::size_t kAnyPoints = 1U << 20;

struct CodingCase {
  RangeCoder coder;
  std::uint32_t cells;
  unsigned intensity_bits;
};
class RangeCoders : public ::testing::TestWithParam<CodingCase> {};

/// A pair that goes through all slices of a test: nothing of a slice may reach into the next.
struct Codec {
  explicit Codec(const SensorModel& model) : encoder(model), decoder(model) {}
  RangeEncoder encoder;
  RangeDecoder decoder;
};

void ExpectRoundTrip(const RangeImage& image, const RangeSettings& settings, Codec* codec) {
  RangeEncoder& encoder = codec->encoder;
  RangeDecoder& decoder = codec->decoder;
  std::vector<std::uint8_t> bytes;
  ASSERT_TRUE(encoder.Encode(image, settings, &bytes));
  ByteReader reader(bytes.data(), bytes.size());
  RangeImage back;
  IntensityScale scale;
  ASSERT_TRUE(decoder.Decode(&reader, kAnyPoints, &back, &scale));
  EXPECT_EQ(reader.remaining(), 0U);
  EXPECT_EQ(back.first_column, image.first_column);
  ASSERT_EQ(back.ranges.size(), image.ranges.size());
  for (std::size_t i = 0; i < image.size(); ++i) {
    const std::uint32_t range = image.ranges[i];
    ASSERT_EQ(back.ranges[i], range == 0 ? 0 : settings.grid.RangeOf(settings.grid.BinOf(range)));
    if (settings.intensity.bits() > 0 && range != 0) {
      ASSERT_EQ(back.intensity[i], settings.intensity.Coarsen(image.intensity[i]));
    }
  }
}

TEST_P(RangeCoders, GiveBackTheBinsTheyWereGiven) {
  const CodingCase& c = GetParam();
  const SensorModel model = test::RoomSensor();
  const RangeSettings settings{c.coder, RangeGrid(1, c.cells),
                               IntensityScale(FullScale::kByte, c.intensity_bits)};
  Codec codec(model);
  ExpectRoundTrip(test::RoomScan(model), settings, &codec);
  ExpectRoundTrip(test::RoomScan(model, 448, 64), settings, &codec);
  codec.decoder = RangeDecoder(model);
  ExpectRoundTrip(test::RoomScan(model, 500, 37), settings, &codec);
}

TEST_P(RangeCoders, GiveBackNoise) {
  const CodingCase& c = GetParam();
  const SensorModel model = test::RoomSensor();
  std::mt19937 random(5);
  Codec codec(model);
  for (const unsigned lost : {0U, 3U, 90U, 100U}) {
    RangeImage image = test::RoomScan(model, 0, 128);
    for (std::size_t i = 0; i < image.size(); ++i) {
      image.ranges[i] =
          random() % 100 < lost ? 0 : 1 + static_cast<std::uint32_t>(random() % 250'000);
      image.intensity[i] = static_cast<std::uint8_t>(random());
    }
    ExpectRoundTrip(
        image, {c.coder, RangeGrid(1, c.cells), IntensityScale(FullScale::kByte, c.intensity_bits)},
        &codec);
    codec.decoder = RangeDecoder(model);
  }
}
INSTANTIATE_TEST_SUITE_P(All, RangeCoders,
                         ::testing::Values(CodingCase{RangeCoder::kDraco, 41, 0},
                                           CodingCase{RangeCoder::kDraco, 41, 5},
                                           CodingCase{RangeCoder::kResidual, 41, 0},
                                           CodingCase{RangeCoder::kResidual, 1, 8},
                                           CodingCase{RangeCoder::kAdaptive, 41, 0},
                                           CodingCase{RangeCoder::kAdaptive, 41, 5},
                                           CodingCase{RangeCoder::kAdaptive, 41, 8},
                                           CodingCase{RangeCoder::kAdaptive, 1, 1},
                                           CodingCase{RangeCoder::kAdaptive, 65'535, 8}));

TEST(Rans, GivesBackEverySymbolWhateverTheModelSaw) {
  std::mt19937 random(3);
  std::vector<unsigned> symbols;
  for (int i = 0; i < 20'000; ++i) {
    const auto r = static_cast<unsigned>(random());
    symbols.push_back(i < 10'000 ? 7U : r % (1U << (r >> 8) % 5));
  }
  RansEncoder encoder;
  encoder.Start(symbols.size());
  NibbleModel model;
  for (std::size_t i = 0; i < symbols.size(); ++i) {
    encoder.Put(symbols[i], &model);
    encoder.PutBits(static_cast<std::uint32_t>(i), static_cast<unsigned>(i % 13));
  }
  std::vector<std::uint8_t> bytes;
  encoder.Finish(&bytes);
  RansDecoder decoder({bytes.data(), bytes.size()});
  NibbleModel again;
  for (std::size_t i = 0; i < symbols.size(); ++i) {
    ASSERT_EQ(decoder.Get(&again), symbols[i]);
    ASSERT_EQ(decoder.GetBits(static_cast<unsigned>(i % 13)), i & ((1U << i % 13) - 1));
  }
  EXPECT_TRUE(decoder.AtEnd());
}

}  // namespace
}  // namespace lidar::codec
