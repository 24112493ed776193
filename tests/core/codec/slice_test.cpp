// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests slices in range geometry from raw points to raw points, above all unusual slices.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "src/codec/effort_control.h"
#include "src/codec/slice_decoder.h"
#include "src/codec/slice_encoder.h"
#include "tests/core/codec/hostile_streams.h"

namespace lidar::codec {
namespace {

constexpr std::uint32_t kMaxPoints = 1U << 20;

/// Encodes the image as a slice, decodes the slice, and returns the decoded ranges.
std::vector<std::uint32_t> CodedRanges(const RangeImage& image, unsigned threads, unsigned effort) {
  const SensorModel model = test::RoomSensor(image.beams);
  const CloudFormat format{test::OrganisedLayout(), image.beams, model};
  const auto raw = test::RawCloud(model, image);
  auto encoder = *SliceEncoder::Create(format);
  encoder.set_threads(threads);
  encoder.set_effort(effort);
  encoder.Load({raw.data(), raw.size()}, image.first_column, true);
  EncodedSlice slice;
  SliceSettings settings;
  settings.intensity_bits = 5;
  std::vector<std::uint32_t> ranges;
  SliceDecoder decoder(format, kMaxPoints);
  // The slice is coded twice, because the first coding must not change the second one.
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(encoder.Encode(settings, &slice), SliceResult::kEncoded);
    const auto shape = decoder.Decode({slice.bytes.data(), slice.bytes.size()});
    EXPECT_TRUE(shape && shape->width == image.columns && shape->height == image.beams);
    if (!shape) return {};
    std::vector<std::uint8_t> back(image.size() * 20);
    decoder.Write(back.data());
    ranges.resize(image.size());
    for (std::size_t k = 0; k < ranges.size(); ++k)
      std::memcpy(&ranges[k], &back[20 * k + 16], sizeof ranges[k]);
  }
  return ranges;
}

class Efforts : public ::testing::TestWithParam<unsigned> {};

TEST_P(Efforts, WithoutAnyReturnComeBackAsSuch) {
  RangeImage image = test::RoomScan(test::RoomSensor(), 64, 64);
  std::fill(image.ranges.begin(), image.ranges.end(), 0U);
  EXPECT_EQ(CodedRanges(image, 1, GetParam()), image.ranges);
}

TEST_P(Efforts, KeepTheErrorOfASingleReturnAtAnyDistanceUpTo268Kilometres) {
  for (const std::uint32_t range : {1U, 19U, 5'000U, 10'000'000U, RangeGrid::kMaxRangeMm}) {
    RangeImage image = test::RoomScan(test::RoomSensor(), 64, 64);
    std::fill(image.ranges.begin(), image.ranges.end(), 0U);
    image.ranges[777] = range;
    const auto back = CodedRanges(image, 1, GetParam());
    ASSERT_EQ(back.size(), image.size());
    EXPECT_NEAR(back[777], range, 20);
    EXPECT_EQ(std::count(back.begin(), back.end(), 0U), 64 * 32 - 1);
  }
}

TEST_P(Efforts, KeepTheErrorNextToAReturnAtTenKilometres) {
  RangeImage image = test::RoomScan(test::RoomSensor(), 64, 64);
  image.ranges[777] = 10'000'000;
  const auto back = CodedRanges(image, 1, GetParam());
  ASSERT_EQ(back.size(), image.size());
  for (std::size_t i = 0; i < back.size(); ++i) {
    ASSERT_NEAR(back[i], image.ranges[i], 20) << i;
    ASSERT_EQ(back[i] == 0, image.ranges[i] == 0) << i;
  }
}

TEST_P(Efforts, AreTheSameCloudFromAnyNumberOfThreads) {
  // The slices have at most two blocks. The second block of the second slice begins after the end
  // of the turn.
  for (const auto& [first_column, columns] : {std::pair(100U, 128U), std::pair(420U, 192U)}) {
    const RangeImage image = test::RoomScan(test::RoomSensor(128), first_column, columns);
    const auto one = CodedRanges(image, 1, GetParam());
    for (const unsigned threads : {2U, 64U}) {
      const auto several = CodedRanges(image, threads, GetParam());
      ASSERT_EQ(several.size(), image.size());
      if (GetParam() < mixing::kSearchingEffort) {
        EXPECT_EQ(several, one);
        continue;
      }
      // Each block chooses its bins independently, so the ranges depend on the number of threads.
      EXPECT_EQ(CodedRanges(image, threads, GetParam()), several);
      for (std::size_t i = 0; i < image.size(); ++i) ASSERT_NEAR(several[i], image.ranges[i], 20);
    }
  }
}

TEST_P(Efforts, KeepBinsThatOnlyTheFastCoderCanCount) {
  RangeImage image = test::RoomScan(test::RoomSensor(), 64, 64);
  image.ranges[5] = RangeGrid::kMaxRangeMm;
  const SensorModel model = test::RoomSensor(image.beams);
  RangeEncoder encoder(model);
  std::vector<std::uint8_t> bytes;
  RangeSettings settings;
  settings.coder = GetParam() > 0 ? RangeCoder::kMixing : RangeCoder::kAdaptive;
  settings.effort = GetParam();
  // Only the fast coder can count bins of 1 mm. Each coder can count bins of 9 mm. The mixing coder
  // cannot count the finer bins that a choice between bins would need.
  for (const RangeGrid& grid : {RangeGrid(), RangeGrid(1, 9)}) {
    settings.grid = grid;
    bytes.clear();
    ASSERT_TRUE(encoder.Encode(image, settings, &bytes));
    RangeDecoder decoder(model);
    ByteReader reader(bytes.data(), bytes.size());
    RangeImage back;
    IntensityScale scale;
    ASSERT_TRUE(decoder.Decode(&reader, kMaxPoints, &back, &scale));
    EXPECT_EQ(decoder.error_m(), grid.error_m());
    for (std::size_t i = 0; i < image.size(); ++i) {
      const std::uint32_t range = image.ranges[i];
      ASSERT_EQ(back.ranges[i], range == 0 ? 0 : grid.RangeOf(grid.BinOf(range))) << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, Efforts, ::testing::Range(0U, EffortControl::kHighest + 1));

/// The settings for coding a slice. With each of these settings, the reported figures of the slice
/// must be true.
struct Coding {
  unsigned threads;
  unsigned effort;
  std::uint32_t thinned_to;  // of 64 beams
  double step_m;
  unsigned intensity_bits;
};
class SliceFigures : public ::testing::TestWithParam<Coding> {};

TEST_P(SliceFigures, AreThoseOfTheDecodedCloud) {
  const Coding& coding = GetParam();
  const SensorModel model = test::RoomSensor(64);
  const RangeImage image = test::RoomScan(model);
  const CloudFormat format{test::OrganisedLayout(), image.beams, model};
  const auto raw = test::RawCloud(model, image);
  auto encoder = *SliceEncoder::Create(format);
  encoder.set_threads(coding.threads);
  encoder.set_effort(coding.effort);
  encoder.Load({raw.data(), raw.size()}, 0, coding.intensity_bits > 0);
  std::vector<bool> kept(image.beams);
  for (std::uint32_t beam = 0; beam < image.beams; ++beam)
    kept[beam] = beam % (image.beams / coding.thinned_to) == 0;
  encoder.Thin(kept);
  EncodedSlice slice;
  ASSERT_EQ(encoder.Encode({0.2, coding.step_m, coding.intensity_bits}, &slice),
            SliceResult::kEncoded);
  SliceDecoder decoder(format, kMaxPoints);
  ASSERT_TRUE(decoder.Decode({slice.bytes.data(), slice.bytes.size()}));
  std::vector<std::uint8_t> back(raw.size());
  decoder.Write(back.data());
  std::size_t returns = 0;
  double error_mm = 0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    std::uint32_t range = 0;
    std::memcpy(&range, &back[20 * i + 16], sizeof range);
    if (range == 0) continue;
    ++returns;
    error_mm = std::max(
        error_mm, std::abs(static_cast<double>(range) - static_cast<double>(image.ranges[i])));
  }
  EXPECT_EQ(encoder.returns(), returns);
  EXPECT_EQ(slice.returns, returns);
  EXPECT_LE(slice.error_m, 0.2);
  EXPECT_LE(error_mm, 1e3 * slice.error_m + 1e-6);
  EXPECT_GE(error_mm, 900 * slice.error_m);
  const SliceDecoder::Quality& quality = decoder.quality();
  EXPECT_EQ(quality.step_m, slice.step_m);
  EXPECT_EQ(quality.error_m, slice.error_m);
  EXPECT_EQ(quality.intensity_bits, coding.intensity_bits);
  EXPECT_EQ(quality.keep_fraction, coding.thinned_to / 64.0);
  // Thin() applies to one slice only, so the next slice has all beams again.
  encoder.Load({raw.data(), raw.size()}, 0, coding.intensity_bits > 0);
  ASSERT_EQ(encoder.Encode({0.2, coding.step_m, coding.intensity_bits}, &slice),
            SliceResult::kEncoded);
  ASSERT_TRUE(decoder.Decode({slice.bytes.data(), slice.bytes.size()}));
  EXPECT_EQ(quality.keep_fraction, 1);
}
INSTANTIATE_TEST_SUITE_P(Of, SliceFigures,
                         ::testing::Values(Coding{1, 0, 64, 0.1, 0}, Coding{4, 0, 64, 0.1, 5},
                                           Coding{1, 1, 16, 0.05, 5}, Coding{3, 1, 32, 0.3, 0},
                                           Coding{2, 2, 8, 0, 3}));

TEST(RangeSlices, TellTheirOwnErrorBehindOneOfAnotherEffort) {
  const RangeImage image = test::RoomScan(test::RoomSensor(), 0, 256);
  const auto raw = test::RawCloud(test::RoomSensor(), image);
  auto encoder = *SliceEncoder::Create(test::RoomFormat());
  encoder.Load({raw.data(), raw.size()}, 0, false);
  SliceDecoder decoder(test::RoomFormat(), kMaxPoints);
  for (const unsigned effort : {EffortControl::kHighest, 0U}) {
    encoder.set_effort(effort);
    EncodedSlice slice;
    ASSERT_EQ(encoder.Encode({effort > 0 ? 0.05 : 0.02, 0, 0}, &slice), SliceResult::kEncoded);
    ASSERT_TRUE(decoder.Decode({slice.bytes.data(), slice.bytes.size()}));
    EXPECT_EQ(decoder.quality().error_m, slice.error_m) << effort;
  }
}

TEST(RangeSlices, ShrinkWithEveryEffort) {
  const RangeImage image = test::RoomScan(test::RoomSensor(), 0, 256);
  const auto raw = test::RawCloud(test::RoomSensor(), image);
  auto encoder = *SliceEncoder::Create(test::RoomFormat());
  encoder.Load({raw.data(), raw.size()}, 0, true);
  SliceSettings settings;
  settings.intensity_bits = 5;
  std::size_t before = raw.size();
  std::vector<std::string> modes;
  for (unsigned effort = 0; effort <= EffortControl::kHighest; ++effort) {
    encoder.set_effort(effort);
    EncodedSlice slice;
    ASSERT_EQ(encoder.Encode(settings, &slice), SliceResult::kEncoded);
    EXPECT_LE(slice.bytes.size(), before) << effort;
    before = slice.bytes.size();
    modes.push_back(encoder.Mode());
  }
  EXPECT_EQ(modes, (std::vector<std::string>{"range-adaptive", "range-mixing1", "range-mixing2",
                                             "range-mixing3"}));
}

TEST(IntensityScale, IsTheSmallestThatHoldsTheLargestIntensity) {
  const std::pair<float, FullScale> cases[] = {
      {0.0F, FullScale::kOne},      {1.0F, FullScale::kOne},    {1.5F, FullScale::kByte},
      {254.0F, FullScale::kByte},   {255.0F, FullScale::kByte}, {256.0F, FullScale::kWord},
      {65'535.0F, FullScale::kWord}};
  for (const auto& [largest, full] : cases)
    EXPECT_EQ(IntensityScale::Fitting(largest), full) << largest;
}

TEST(IntensityScale, HasEvenLevelsOfWhichEachDecodesToTheMeanOfItsIntegers) {
  struct Row {
    FullScale full;
    unsigned bits;
    float intensity;
    unsigned level;
    float value;
  };
  for (const Row& row :
       {Row{FullScale::kOne, 3, 0, 0, 0}, Row{FullScale::kOne, 3, 0.07F, 0, 0},
        Row{FullScale::kOne, 3, 0.08F, 1, 1.0F / 7}, Row{FullScale::kOne, 3, 0.51F, 4, 4.0F / 7},
        Row{FullScale::kOne, 3, 1, 7, 1}, Row{FullScale::kOne, 3, 2, 7, 1},
        Row{FullScale::kByte, 5, 0, 0, 3.5F}, Row{FullScale::kByte, 5, 7, 0, 3.5F},
        Row{FullScale::kByte, 5, 8, 1, 11.5F}, Row{FullScale::kByte, 5, 255, 31, 251.5F},
        Row{FullScale::kByte, 5, 300, 31, 251.5F}, Row{FullScale::kByte, 8, 100, 100, 100},
        Row{FullScale::kWord, 8, 255, 0, 127.5F}, Row{FullScale::kWord, 8, 256, 1, 383.5F},
        Row{FullScale::kWord, 8, 65'535, 255, 65'407.5F}, Row{FullScale::kByte, 5, -9, 0, 3.5F},
        Row{FullScale::kOne, 3, std::nanf(""), 0, 0}}) {
    const IntensityScale scale(row.full, row.bits);
    EXPECT_EQ(scale.LevelOf(row.intensity), row.level) << row.intensity << ", " << row.bits;
    EXPECT_FLOAT_EQ(scale.ValueOf(static_cast<std::uint8_t>(row.level)), row.value) << row.level;
    const auto fine = IntensityScale(row.full, 8).LevelOf(row.intensity);
    EXPECT_EQ(scale.Coarsen(fine), row.level) << row.intensity << ", " << row.bits;
  }
}

/// Returns two blocks of a slice. The second block begins in the column `second`. Its intensities
/// have `bits` bits and reach up to `full`.
std::vector<std::uint8_t> TwoBlocks(std::uint32_t second, unsigned bits,
                                    FullScale full = FullScale::kByte) {
  const SensorModel model = test::RoomSensor();
  RangeEncoder encoder(model);
  std::vector<std::uint8_t> bytes;
  const IntensityScale five(FullScale::kByte, 5);
  encoder.Encode(test::RoomScan(model, 0, 40), {RangeCoder::kAdaptive, RangeGrid(1, 41), five},
                 &bytes);
  encoder.Encode(test::RoomScan(model, second, 40),
                 {RangeCoder::kAdaptive, RangeGrid(1, 41), IntensityScale(full, bits)}, &bytes);
  return bytes;
}

TEST(RangeSlices, AreRefusedWhereTheirBlocksDoNotAdjoinOrAreOfAnotherKind) {
  SliceDecoder decoder(test::RoomFormat(), kMaxPoints);
  const auto decodes = [&](const std::vector<std::uint8_t>& bytes) {
    return decoder.Decode({bytes.data(), bytes.size()}).has_value();
  };
  EXPECT_TRUE(decodes(TwoBlocks(40, 5)));
  for (const std::uint32_t second : {39U, 41U, 0U, 80U})
    EXPECT_FALSE(decodes(TwoBlocks(second, 5)));
  EXPECT_FALSE(decodes(TwoBlocks(40, 4)));
  EXPECT_FALSE(decodes(TwoBlocks(40, 0)));
  EXPECT_FALSE(decodes(TwoBlocks(40, 5, FullScale::kWord)));
}

TEST(RangeSlices, HaveNoMorePointsInAllTheirBlocksThanIsAllowed) {
  const auto bytes = TwoBlocks(40, 5);
  constexpr std::uint32_t kPoints = 2 * 40 * 32;
  for (const std::uint32_t allowed : {kPoints, kPoints - 1, kPoints / 2, kPoints / 2 - 1}) {
    SliceDecoder decoder(test::RoomFormat(), allowed);
    EXPECT_EQ(decoder.Decode({bytes.data(), bytes.size()}).has_value(), allowed == kPoints)
        << allowed;
  }
}

TEST(RangeSlices, HaveNoMoreColumnsThanATurn) {
  SensorModel finer = test::RoomSensor();
  finer.columns_per_scan = 1'024;
  for (const std::uint32_t columns : {511U, 512U, 513U, 1'024U}) {
    RangeEncoder encoder(finer);
    RangeImage wall;
    wall.beams = 32;
    wall.columns = columns;
    wall.ranges.assign(wall.size(), 5'000);
    std::vector<std::uint8_t> bytes;
    ASSERT_TRUE(encoder.Encode(wall, {}, &bytes));
    SliceDecoder decoder(test::RoomFormat(), kMaxPoints);
    EXPECT_EQ(decoder.Decode({bytes.data(), bytes.size()}).has_value(), columns <= 512) << columns;
  }
}

TEST(RangeSlices, HaveNoMoreColumnsThanATurnInAllTheirBlocks) {
  const auto encode = [](std::uint32_t first_column, std::uint32_t columns,
                         std::vector<std::uint8_t>* bytes) {
    RangeEncoder encoder(test::RoomSensor());
    RangeImage wall;
    wall.beams = 32;
    wall.columns = columns;
    wall.first_column = first_column;
    wall.ranges.assign(wall.size(), 5'000);
    EXPECT_TRUE(encoder.Encode(wall, {}, bytes));
  };
  for (const std::uint32_t second : {111U, 112U, 113U, 512U}) {
    std::vector<std::uint8_t> bytes;
    encode(0, 400, &bytes);
    encode(400, second, &bytes);
    SliceDecoder decoder(test::RoomFormat(), kMaxPoints);
    EXPECT_EQ(decoder.Decode({bytes.data(), bytes.size()}).has_value(), second <= 112) << second;
  }
}

TEST(RangeSlices, AreNeverCoarserThanTheirErrorAllowsWhateverTheStep) {
  const RangeImage image = test::RoomScan(test::RoomSensor(), 0, 64);
  const auto raw = test::RawCloud(test::RoomSensor(), image);
  auto encoder = *SliceEncoder::Create(test::RoomFormat());
  encoder.Load({raw.data(), raw.size()}, 0, false);
  EncodedSlice slice;
  SliceSettings settings;
  settings.max_error_m = 0.02;
  for (const double step : {0.0, 0.01, 0.04, 0.05, 1.0, 100.0}) {
    settings.step_m = step;
    ASSERT_EQ(encoder.Encode(settings, &slice), SliceResult::kEncoded);
    EXPECT_LE(slice.error_m, 0.02 + 1e-9) << step;
    EXPECT_NEAR(slice.step_m, step > 0 ? std::min(step, 0.041) : 0.041, 0.001) << step;
  }
}

TEST(RangeSlices, MayBeginBehindTheEndOfATurn) {
  const RangeImage image = test::RoomScan(test::RoomSensor(128), 64, 128);
  const auto raw = test::RawCloud(test::RoomSensor(128), image);
  const CloudFormat format{test::OrganisedLayout(), 128, test::RoomSensor(128)};
  for (const unsigned threads : {1U, 2U}) {
    std::vector<std::vector<std::uint8_t>> coded;
    for (const std::uint32_t first_column : {448U, 512U + 448U, 512U * 1'000 + 448U}) {
      auto encoder = *SliceEncoder::Create(format);
      encoder.set_threads(threads);
      encoder.Load({raw.data(), raw.size()}, first_column, true);
      EncodedSlice slice;
      ASSERT_EQ(encoder.Encode({}, &slice), SliceResult::kEncoded) << first_column;
      coded.push_back(slice.bytes);
      SliceDecoder decoder(format, kMaxPoints);
      const auto shape = decoder.Decode({slice.bytes.data(), slice.bytes.size()});
      ASSERT_TRUE(shape);
      EXPECT_EQ(shape->first_column, 448U);
    }
    EXPECT_EQ(coded[1], coded[0]);
    EXPECT_EQ(coded[2], coded[0]);
  }
}

TEST(CommonUnits, AreWhatAllRangesAreMultiplesOf) {
  const auto unit = [](const std::vector<std::uint32_t>& ranges, std::uint32_t sensor_unit) {
    return CommonUnit(ranges, sensor_unit);
  };
  EXPECT_EQ(unit({}, 8), 8U);
  EXPECT_EQ(unit({0, 0}, 3), 3U);
  EXPECT_EQ(unit({4000, 0, 1004, 12}, 1), 4U);
  EXPECT_EQ(unit({16, 24, 160}, 8), 8U);
  EXPECT_EQ(unit({16, 24, 161}, 8), 1U);
  EXPECT_EQ(unit({6000}, 4), 4U) << "a step of 6 m is more than the format takes";
  EXPECT_EQ(unit({6001}, 4), 1U);
  std::vector<std::uint32_t> late(500, 3'000);
  late.push_back(14);
  EXPECT_EQ(unit(late, 1), 2U) << "behind the sample";
}

TEST_P(Efforts, KeepTheErrorOfRangesWithACommonDivisor) {
  RangeImage image = test::RoomScan(test::RoomSensor(), 64, 64);
  for (std::uint32_t& range : image.ranges) range = range / 4 * 4;
  const auto back = CodedRanges(image, 1, GetParam());
  for (std::size_t i = 0; i < back.size(); ++i) EXPECT_NEAR(back[i], image.ranges[i], 20);
}

class HostileSlices : public ::testing::TestWithParam<unsigned> {
 protected:
  void SetUp() override {
    const auto raw = test::SmallSlice();
    auto encoder = *SliceEncoder::Create(test::RoomFormat());
    encoder.set_effort(GetParam());
    encoder.Load({raw.data(), raw.size()}, 0, true);
    SliceSettings settings;
    settings.intensity_bits = 5;
    EncodedSlice slice;
    ASSERT_EQ(encoder.Encode(settings, &slice), SliceResult::kEncoded);
    stream_ = slice.bytes;
  }
  std::vector<std::uint8_t> stream_;
};

// At effort 0, the decoder notices all damage except in the header, where another step or another
// first column is valid. The mixing coder notices little damage; the CRC of the payload format is
// there for that.
TEST_P(HostileSlices, GiveACloudWithinLimitsOrNone) {
  SliceDecoder decoder(test::RoomFormat(), test::kHostileMaxPoints);
  const int decoded = test::CountDecodedMutations(stream_, &decoder);
  if (GetParam() == 0) {
    EXPECT_LE(decoded, 0.03 * test::kMutations);
  }
}

TEST_P(HostileSlices, ThatAreCutOffGiveNothing) {
  SliceDecoder decoder(test::RoomFormat(), test::kHostileMaxPoints);
  test::ExpectNothingOfCutStreams(stream_, true, &decoder);
}

TEST_P(HostileSlices, OfFieldsWithOddTypesStayInsideTheirBuffer) {
  SliceDecoder decoder(test::OddFormat(), test::kHostileMaxPoints);
  test::ExpectOddFieldsToStayZero(stream_, &decoder);
}
INSTANTIATE_TEST_SUITE_P(All, HostileSlices, ::testing::Values(0U, 1U, EffortControl::kHighest));

}  // namespace
}  // namespace lidar::codec
