// SPDX-License-Identifier: LGPL-2.1-or-later
// The own coder gives the bytes that it always gave.
#include "tests/core/codec/golden.h"

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
        // A whole turn in lanes, whose last column is the neighbour of the first.
        GoldenBlock{"adaptive_turn", RangeCoder::kAdaptive, {8, 1024, 0, 1, 10}, 41 * 256, 5},
        // Short rows, a step between whole cells of 8 mm, beams left out.
        GoldenBlock{"adaptive_slice",
                    RangeCoder::kAdaptive,
                    {16, 128, 960, 8, 25},
                    5 * 256 + 77,
                    0,
                    FullScale::kByte,
                    12},
        // Every pixel has a return, so there is no mask.
        GoldenBlock{
            "adaptive_dense", RangeCoder::kAdaptive, {4, 300, 100, 1, 0}, 256, 8, FullScale::kWord},
        GoldenBlock{"adaptive_empty", RangeCoder::kAdaptive, {4, 64, 0, 1, 100}, 256, 0},
        // Each effort of the mixing coder: turns and sectors, with levels and without, all gaps.
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

}  // namespace
}  // namespace lidar::codec
