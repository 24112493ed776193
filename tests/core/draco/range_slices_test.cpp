// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests range geometry with Draco's coders. Also tests how the decoders of all of Draco's coders
// handle damaged streams.
#include <gtest/gtest.h>

#include "ext/draco/draco_integers.h"
#include "ext/draco/slice_coder.h"
#include "tests/core/codec/hostile_streams.h"
#include "tests/core/codec/round_trips.h"

namespace lidar::draco {
namespace {

using codec::RangeCoder;

class RangeCoders : public ::testing::TestWithParam<test::CodingCase> {};
TEST_P(RangeCoders, GiveBackTheBinsTheyWereGiven) {
  test::ExpectBinsOfRooms(GetParam(), DracoIntegers::Shared());
}
TEST_P(RangeCoders, GiveBackNoise) { test::ExpectBinsOfNoise(GetParam(), DracoIntegers::Shared()); }
INSTANTIATE_TEST_SUITE_P(All, RangeCoders,
                         ::testing::Values(test::CodingCase{RangeCoder::kDraco, 41, 0},
                                           test::CodingCase{RangeCoder::kDraco, 41, 5},
                                           test::CodingCase{RangeCoder::kResidual, 41, 0},
                                           test::CodingCase{RangeCoder::kResidual, 1, 8},
                                           test::CodingCase{RangeCoder::kDraco, 2.75, 0}));

TEST_P(RangeCoders, RefuseAWordBehindTheEndOfTheMask) {
  test::ExpectNoWordBehind(GetParam().coder, DracoIntegers::Shared(),
                           &codec::RangeHeader::mask_size);
}

TEST(CoderOfIntegers, IsOneForAll) { EXPECT_EQ(DracoIntegers::Shared(), DracoIntegers::Shared()); }

TEST(RangeSlices, OfDracosCodersAreRefusedWhereDracoIsNot) {
  const auto raw = test::SmallSlice();
  auto encoder = *SliceEncoder::Create(test::RoomFormat(), Geometry::kRange, RangeCoder::kResidual);
  encoder.Load({raw.data(), raw.size()}, 0, false);
  codec::EncodedSlice slice;
  ASSERT_EQ(encoder.Encode({}, &slice), codec::SliceResult::kEncoded);
  codec::SliceDecoder decoder(test::RoomFormat(), test::kHostileMaxPoints);
  EXPECT_FALSE(decoder.Decode({slice.bytes.data(), slice.bytes.size()}));
  auto own = *codec::SliceEncoder::Create(test::RoomFormat(), RangeCoder::kResidual);
  own.Load({raw.data(), raw.size()}, 0, false);
  EXPECT_EQ(own.Encode({}, &slice), codec::SliceResult::kEmpty);
}

struct StreamCase {
  const char* name;
  Geometry geometry;
  RangeCoder coder;
  unsigned level;
};
class HostileStreams : public ::testing::TestWithParam<StreamCase> {
 protected:
  static std::vector<std::uint8_t> Stream() {
    const StreamCase& c = GetParam();
    const auto raw = test::SmallSlice();
    auto encoder = *SliceEncoder::Create(test::RoomFormat(), c.geometry, c.coder);
    encoder.Load({raw.data(), raw.size()}, 0, true);
    SliceSettings settings;
    settings.level = c.level;
    settings.intensity_bits = 5;
    codec::EncodedSlice slice;
    EXPECT_EQ(encoder.Encode(settings, &slice), codec::SliceResult::kEncoded);
    return slice.bytes;
  }
};

// Draco itself notices hardly any damage. The CRC of the payload format is there for that.
TEST_P(HostileStreams, OfAnyMutationGiveACloudWithinLimitsOrNone) {
  SliceDecoder decoder(test::RoomFormat(), GetParam().geometry, test::kHostileMaxPoints);
  test::CountDecodedMutations(Stream(), &decoder);
}

TEST_P(HostileStreams, ThatAreCutOffGiveNothing) {
  SliceDecoder decoder(test::RoomFormat(), GetParam().geometry, test::kHostileMaxPoints);
  test::ExpectNothingOfCutStreams(Stream(), GetParam().geometry == Geometry::kRange, &decoder);
}

TEST_P(HostileStreams, OfFieldsWithOddTypesStayInsideTheirBuffer) {
  SliceDecoder decoder(test::OddFormat(), GetParam().geometry, test::kHostileMaxPoints);
  test::ExpectOddFieldsToStayZero(Stream(), &decoder);
}

INSTANTIATE_TEST_SUITE_P(
    All, HostileStreams,
    ::testing::Values(StreamCase{"sequential", Geometry::kXyz, RangeCoder::kDraco, 0},
                      StreamCase{"kd", Geometry::kXyz, RangeCoder::kDraco, 7},
                      StreamCase{"draco", Geometry::kRange, RangeCoder::kDraco, 7},
                      StreamCase{"residual", Geometry::kRange, RangeCoder::kResidual, 7},
                      StreamCase{"adaptive", Geometry::kRange, RangeCoder::kAdaptive, 7}),
    [](const auto& c) { return c.param.name; });

}  // namespace
}  // namespace lidar::draco
