// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/mixing/binary_coder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace lidar::codec::mixing {
namespace {

struct Bit {
  bool bit;
  std::int32_t chance;
};

std::vector<Bit> RandomBits(std::size_t count, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<Bit> bits;
  for (std::size_t i = 0; i < count; ++i) {
    const std::int32_t chance =
        kLeastChance + static_cast<std::int32_t>(random() % (kMostChance - kLeastChance + 1));
    bits.push_back({static_cast<std::int32_t>(random() % kOne) < chance, chance});
  }
  return bits;
}

std::vector<std::uint8_t> Encode(const std::vector<Bit>& bits) {
  std::vector<std::uint8_t> bytes;
  BinaryEncoder encoder(&bytes);
  for (const Bit& b : bits) encoder.Code(b.bit, b.chance);
  encoder.Finish();
  return bytes;
}

TEST(BinaryCoder, GivesBackWhatWasCoded) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    const auto bits = RandomBits(seed, seed);
    const auto bytes = Encode(bits);
    BinaryDecoder decoder({bytes.data(), bytes.size()});
    for (const Bit& b : bits) ASSERT_EQ(decoder.Code(false, b.chance), b.bit) << seed;
    EXPECT_TRUE(decoder.AtEnd()) << seed;
  }
}

TEST(BinaryCoder, NeedsTheEntropyAndHalfAByteOrTwo) {
  const auto bits = RandomBits(100'000, 1);
  double entropy = 0;
  for (const Bit& b : bits)
    entropy -= std::log2((b.bit ? b.chance : kOne - b.chance) / double{kOne});
  EXPECT_LT(8.0 * static_cast<double>(Encode(bits).size()), 1.0005 * entropy + 16);
}

TEST(BinaryCoder, WritesNothingForNothing) { EXPECT_TRUE(Encode({}).empty()); }

TEST(BinaryCoder, TellsWhenItReadsWhatNobodyWrote) {
  const auto bits = RandomBits(1'000, 2);
  const auto bytes = Encode(bits);
  BinaryDecoder decoder({bytes.data(), bytes.size() / 2});
  for (const Bit& b : bits) decoder.Code(false, b.chance);
  EXPECT_TRUE(decoder.overran());
  EXPECT_FALSE(decoder.AtEnd());
}

TEST(BinaryCoder, ReadsFourBytesThatAreNotThereAndNoMore) {
  BinaryDecoder decoder({});
  EXPECT_FALSE(decoder.overran());
  decoder.Code(false, 256);  // The bit has the chance 1/256, so the decoder reads another byte.
  EXPECT_TRUE(decoder.overran());
}

TEST(Tables, RiseAndInvertEachOther) {
  for (std::int32_t x = -kMostLogit; x < kMostLogit; ++x) ASSERT_LE(Chance(x), Chance(x + 1));
  for (std::int32_t p = 64; p < kOne - 64; p += 16)
    ASSERT_NEAR(Chance(Logit(static_cast<std::uint32_t>(p))), p, 200) << p;
  for (std::uint32_t v = 1; v < 65'536; ++v) ASSERT_NEAR(Log(v), 256 * std::log(v), 3) << v;
}

}  // namespace
}  // namespace lidar::codec::mixing
