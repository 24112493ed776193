// SPDX-License-Identifier: LGPL-2.1-or-later
// Blocks that refer to others: their bytes, what they need, and what a decoder remembers.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>

#include "src/codec/range_codec.h"
#include "tests/core/codec/golden.h"

namespace lidar::codec {
namespace {

/// Two blocks of a room, the second by the first.
struct Pair {
  SensorModel model = test::GoldenSensor(16, 256);
  RangeSettings settings;
  std::vector<std::uint8_t> key;
  std::vector<std::uint8_t> dependent;

  explicit Pair(unsigned effort = 2) {
    settings.coder = RangeCoder::kMixing;
    settings.effort = effort;
    settings.grid = RangeGrid(1, 41);
    RangeImage image = test::GoldenImage({16, 128, 64, 1, 10});
    image.intensity.clear();
    RangeEncoder encoder(model);
    BlockLink link;
    EXPECT_TRUE(encoder.Encode(image, settings, &key, &link));
    link.reference = link.left;
    for (std::size_t i = 0; i < image.size(); ++i)
      if (image.ranges[i] != 0) image.ranges[i] += static_cast<std::uint32_t>(i * 7 % 19);
    EXPECT_TRUE(encoder.Encode(image, settings, &dependent, &link));
  }
  /// True where `bytes` is a block; `decoder` says why not.
  bool Decode(const std::vector<std::uint8_t>& bytes, RangeDecoder* decoder,
              BlockStore* store) const {
    ByteReader reader(bytes.data(), bytes.size());
    RangeImage image;
    IntensityScale scale;
    return decoder->Decode(&reader, 1U << 20, &image, &scale, store);
  }
};

class TemporalBlocks : public ::testing::TestWithParam<unsigned> {};
TEST_P(TemporalBlocks, AreTheBytesThatTheyAlwaysWere) {
  const Pair pair(GetParam());
  const std::string name = GOLDEN_FOLDER "/temporal" + std::to_string(GetParam());
  test::ExpectGolden(name + "_key.bin", pair.key);
  test::ExpectGolden(name + "_dependent.bin", pair.dependent);
  EXPECT_LT(pair.dependent.size(), pair.key.size());
}
INSTANTIATE_TEST_SUITE_P(Efforts, TemporalBlocks, ::testing::Values(1U, 2U, 3U));

TEST(Temporal, BlocksNeedTheirReferenceAndNothingElse) {
  const Pair pair;
  RangeDecoder decoder(pair.model);
  BlockStore store;
  EXPECT_FALSE(pair.Decode(pair.dependent, &decoder, &store));
  EXPECT_TRUE(decoder.lacks_reference());
  EXPECT_FALSE(pair.Decode(pair.dependent, &decoder, nullptr));
  EXPECT_TRUE(decoder.lacks_reference());
  EXPECT_TRUE(pair.Decode(pair.key, &decoder, nullptr));
  EXPECT_TRUE(pair.Decode(pair.key, &decoder, &store));
  EXPECT_TRUE(pair.Decode(pair.dependent, &decoder, &store));
  EXPECT_FALSE(decoder.lacks_reference());
  EXPECT_EQ(store.size(), 2U);
}

TEST(Temporal, DamagedBlocksAreRefusedOrGiveAnImageAndNeverFillTheMemory) {
  const Pair pair;
  RangeDecoder decoder(pair.model);
  BlockStore store;
  ASSERT_TRUE(pair.Decode(pair.key, &decoder, &store));
  std::mt19937 random(3);
  for (int i = 0; i < 300; ++i) {
    auto bytes = i % 2 == 0 ? pair.key : pair.dependent;
    bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1 + random() % 255);
    if (i % 3 == 0) bytes.resize(bytes.size() - random() % 40);
    pair.Decode(bytes, &decoder, &store);
    ASSERT_LE(store.size(), 40 * BlockStore::kMostOfSector);
  }
}

TEST(Temporal, MemoryOfADecoderIsBounded) {
  const Pair pair;
  BlockStore store;
  RangeImage place;
  place.beams = 1;
  place.columns = 4;
  const auto add = [&](std::uint32_t first_column, std::uint32_t crc) {
    auto block = std::make_shared<BlockMemory>();
    block->beams = place.beams;
    block->columns = place.columns;
    block->first_column = first_column;
    block->crc = crc;
    store.Add(std::move(block));
  };
  for (std::uint32_t i = 0; i < 100; ++i) add(0, i);
  EXPECT_EQ(store.size(), BlockStore::kMostOfSector);
  for (std::uint32_t i = 0; i < 1'000; ++i) add(i, 7);
  EXPECT_LE(store.size(), BlockStore::kMostBytes / sizeof(BlockMemory));
  EXPECT_EQ(store.Recall(7, place), nullptr);  // the oldest is gone
  place.first_column = 999;
  EXPECT_NE(store.Recall(7, place), nullptr);
}

TEST(Temporal, ReferencesMakeTheDecoderForgetWhatIsMuchOlder) {
  BlockStore store;
  RangeImage place;
  for (std::uint32_t i = 0; i < 20; ++i) {
    auto block = std::make_shared<BlockMemory>();
    block->crc = i;
    store.Add(std::move(block));
  }
  EXPECT_NE(store.Recall(15, place), nullptr);
  EXPECT_EQ(store.size(), 5 + BlockStore::kOvertaking);
  EXPECT_EQ(store.Recall(3, place), nullptr);
}

}  // namespace
}  // namespace lidar::codec
