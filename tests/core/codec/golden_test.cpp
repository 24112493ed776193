// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests that the range coders still write the bytes of the golden files.
#include "tests/core/codec/golden.h"

#include "src/base/byte_writer.h"
#include "src/base/crc.h"

namespace lidar::codec {
namespace {

using test::GoldenBlock;

class GoldenBytes : public ::testing::TestWithParam<GoldenBlock> {};
TEST_P(GoldenBytes, AreWhatABlockIsCodedTo) {
  test::ExpectGoldenBlock(GetParam(), GOLDEN_FOLDER, nullptr);
}
INSTANTIATE_TEST_SUITE_P(
    All, GoldenBytes,
    ::testing::Values(
        // A whole turn. The last column is the neighbour of the first column.
        GoldenBlock{"adaptive_turn", RangeCoder::kAdaptive, {8, 1024, 0, 1, 10}, 41 * 256, 5},
        // A sector with short rows, with a step that is no multiple of the 8 mm cells, and with
        // some beams left out.
        GoldenBlock{"adaptive_slice",
                    RangeCoder::kAdaptive,
                    {16, 128, 960, 8, 25},
                    5 * 256 + 77,
                    0,
                    FullScale::kByte,
                    12},
        // Each pixel has a return, so there is no mask.
        GoldenBlock{
            "adaptive_dense", RangeCoder::kAdaptive, {4, 300, 100, 1, 0}, 256, 8, FullScale::kWord},
        GoldenBlock{"adaptive_empty", RangeCoder::kAdaptive, {4, 64, 0, 1, 100}, 256, 0},
        // Blended contexts: a whole turn, a sector whose rows are no multiple of a group, a sector
        // in which each pixel has a return, and a sector without returns.
        GoldenBlock{"blended_turn", RangeCoder::kBlended, {8, 1024, 0, 1, 10}, 41 * 256, 5},
        GoldenBlock{"blended_slice",
                    RangeCoder::kBlended,
                    {16, 126, 960, 8, 25},
                    5 * 256 + 77,
                    0,
                    FullScale::kByte,
                    12},
        GoldenBlock{
            "blended_dense", RangeCoder::kBlended, {4, 300, 100, 1, 0}, 256, 8, FullScale::kWord},
        GoldenBlock{"blended_empty", RangeCoder::kBlended, {4, 64, 0, 1, 100}, 256, 0},
        // The mixing coder at each effort: whole turns and sectors, with and without intensity
        // levels. The last case of the list has gaps only.
        GoldenBlock{"mixing1_turn",
                    RangeCoder::kMixing,
                    {8, 1024, 0, 1, 10},
                    41 * 256,
                    5,
                    FullScale::kByte,
                    0,
                    1024,
                    1},
        GoldenBlock{"mixing2_slice",
                    RangeCoder::kMixing,
                    {16, 128, 960, 8, 25},
                    5 * 256 + 77,
                    0,
                    FullScale::kByte,
                    12,
                    1024,
                    2},
        GoldenBlock{"mixing3_dense",
                    RangeCoder::kMixing,
                    {4, 300, 100, 1, 0},
                    256,
                    8,
                    FullScale::kWord,
                    0,
                    1024,
                    3},
        GoldenBlock{"mixing3_turn",
                    RangeCoder::kMixing,
                    {8, 1024, 0, 1, 30},
                    101 * 256,
                    3,
                    FullScale::kByte,
                    0,
                    1024,
                    3},
        // The mixing coder with refined models.
        GoldenBlock{"refined2_slice",
                    RangeCoder::kMixing,
                    {16, 128, 960, 8, 25},
                    5 * 256 + 77,
                    5,
                    FullScale::kByte,
                    0,
                    1024,
                    2,
                    true},
        GoldenBlock{"refined3_turn",
                    RangeCoder::kMixing,
                    {8, 1024, 0, 1, 30},
                    101 * 256,
                    0,
                    FullScale::kByte,
                    0,
                    1024,
                    3,
                    true},
        GoldenBlock{"mixing2_empty",
                    RangeCoder::kMixing,
                    {4, 64, 0, 1, 100},
                    256,
                    0,
                    FullScale::kByte,
                    0,
                    1024,
                    2}),
    [](const auto& c) { return c.param.name; });

/// Decodes a block whose bins an encoder chose. The format does not prescribe the choice, so the
/// file stays the same when an encoder chooses better.
TEST(GoldenChoice, ComesBackAsItWasChosen) {
  const test::GoldenScan scan{16, 256, 512, 1, 5};
  const SensorModel model = test::GoldenSensor(scan.beams, 1024);
  const RangeImage image = test::GoldenImage(scan);
  const RangeGrid grid(1, 201);
  const std::string file = std::string(GOLDEN_FOLDER) + "/mixing3_chosen.bin";
  if (std::getenv("UPDATE_GOLDEN") != nullptr) {
    std::vector<std::uint8_t> bytes;
    ASSERT_TRUE(RangeEncoder(model).Encode(
        image, {RangeCoder::kMixing, grid, IntensityScale(FullScale::kByte, 5), 0, 3}, &bytes));
    test::ExpectGolden(file, bytes);
  }
  const std::vector<std::uint8_t> golden = test::ReadGolden(file);
  RangeDecoder decoder(model);
  ByteReader reader(golden.data(), golden.size());
  RangeImage back;
  IntensityScale scale;
  ASSERT_TRUE(decoder.Decode(&reader, image.size(), &back, &scale));
  EXPECT_EQ(decoder.header().grid.parts(), 134U * RangeGrid::kParts);
  EXPECT_EQ(decoder.error_m(), 0.1);
  std::vector<std::uint8_t> ranges;
  ByteWriter writer(&ranges);
  for (std::size_t i = 0; i < image.size(); ++i) {
    writer.Le32(back.ranges[i]);
    ASSERT_EQ(back.ranges[i] == 0, image.ranges[i] == 0);
    ASSERT_LE(std::abs(std::int64_t{back.ranges[i]} - image.ranges[i]), 100);
    if (back.ranges[i] == 0) continue;
    ASSERT_EQ(back.intensity[i], scale.Coarsen(image.intensity[i]));
  }
  EXPECT_EQ(Crc32({ranges.data(), ranges.size()}), 951'902'675U);
}

}  // namespace
}  // namespace lidar::codec
