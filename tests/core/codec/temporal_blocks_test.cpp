// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests blocks that refer to other blocks: their bytes, the blocks that they need, and the blocks
// that a decoder remembers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <random>

#include "src/codec/range_codec.h"
#include "src/codec/slice_links.h"
#include "tests/core/codec/golden.h"

namespace lidar::codec {
namespace {

/// Two blocks that show a room. The second block refers to the first one.
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
  /// Decodes a block. Returns false if `bytes` are no valid block; `decoder` then has the reason.
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

TEST(Temporal, BlocksWithFewerBeamsAreNoReference) {
  const SensorModel model = test::GoldenSensor(16, 256);
  RangeImage image = test::GoldenImage({16, 128, 64, 1, 10});
  image.intensity.clear();
  for (const std::uint32_t kept : {0U, 8U}) {
    RangeEncoder encoder(model);
    RangeSettings settings;
    settings.coder = RangeCoder::kMixing;
    settings.grid = RangeGrid(1, 41);
    settings.kept_beams = kept;
    std::vector<std::uint8_t> bytes;
    BlockLink link;
    ASSERT_TRUE(encoder.Encode(image, settings, &bytes, &link));
    EXPECT_EQ(link.left != nullptr, kept == 0) << "others would see beams that were left out";
    EXPECT_EQ(LinksOf({bytes.data(), bytes.size()})->size(), kept == 0 ? 1U : 0U);
  }
}

TEST(Temporal, BlocksNeedTheirReferenceAndNothingElse) {
  const Pair pair;
  RangeDecoder decoder(pair.model);
  BlockStore store;
  EXPECT_FALSE(pair.Decode(pair.dependent, &decoder, &store));
  EXPECT_TRUE(decoder.lacks_reference());
  EXPECT_FALSE(pair.Decode(pair.dependent, &decoder, nullptr));
  EXPECT_TRUE(decoder.lacks_reference());
  EXPECT_FALSE(pair.Decode({0x00}, &decoder, &store));
  EXPECT_FALSE(decoder.lacks_reference()) << "damage is no lack of a reference";
  EXPECT_TRUE(pair.Decode(pair.key, &decoder, nullptr));
  EXPECT_TRUE(pair.Decode(pair.key, &decoder, &store));
  EXPECT_TRUE(pair.Decode(pair.dependent, &decoder, &store));
  EXPECT_FALSE(decoder.lacks_reference());
  EXPECT_EQ(store.size(), 2U);
}

TEST(SliceLinks, AreTheNamesThatBlocksHaveForDecoders) {
  const Pair pair;
  const auto key = LinksOf({pair.key.data(), pair.key.size()});
  ASSERT_TRUE(key && key->size() == 1);
  EXPECT_FALSE(key->front().reference);
  const auto dependent = LinksOf({pair.dependent.data(), pair.dependent.size()});
  ASSERT_TRUE(dependent && dependent->size() == 1);
  EXPECT_EQ(dependent->front().reference, key->front().crc);
  std::vector<std::uint8_t> both = pair.key;
  both.insert(both.end(), pair.dependent.begin(), pair.dependent.end());
  EXPECT_EQ(LinksOf({both.data(), both.size()})->size(), 2U);
}

TEST(SliceLinks, LeaveOutBlocksToWhichNoneCanRefer) {
  const Pair pair;
  RangeImage image = test::GoldenImage({16, 128, 64, 1, 10});
  RangeEncoder encoder(pair.model);
  std::vector<std::uint8_t> alone;
  ASSERT_TRUE(encoder.Encode(image, pair.settings, &alone));
  EXPECT_TRUE(LinksOf({alone.data(), alone.size()})->empty());
  std::vector<std::uint8_t> all;
  for (const auto& block : {alone, pair.key, alone, pair.dependent, alone})
    all.insert(all.end(), block.begin(), block.end());
  const auto links = LinksOf({all.data(), all.size()});
  ASSERT_TRUE(links && links->size() == 2);
  EXPECT_EQ(links->front().crc, LinksOf({pair.key.data(), pair.key.size()})->front().crc);
  EXPECT_EQ(links->back().reference, links->front().crc);
}

TEST(SliceLinks, OfDamagedBytesAreNone) {
  const Pair pair;
  for (std::size_t size = 0; size < pair.dependent.size(); ++size)
    ASSERT_FALSE(LinksOf({pair.dependent.data(), size})) << size;
  std::vector<std::uint8_t> longer = pair.dependent;
  longer.push_back(0);
  EXPECT_FALSE(LinksOf({longer.data(), longer.size()}));
}

/// Returns scans of the same room. Each scan has different noise.
std::vector<RangeImage> NoisyScans(int count) {
  std::vector<RangeImage> scans(static_cast<std::size_t>(count),
                                test::GoldenImage({16, 256, 0, 1, 1}));
  std::mt19937 random(9);
  for (RangeImage& scan : scans) {
    scan.intensity.clear();
    for (std::uint32_t& range : scan.ranges)
      if (range != 0) range += static_cast<std::uint32_t>(random() % 16 + random() % 16);
  }
  return scans;
}

/// The results of coding NoisyScans() at one effort: the bytes of the dependent blocks, the largest
/// error of a decoded range [mm], and the number of blocks with chosen bins.
struct Repeated {
  std::size_t bytes = 0;
  int error_mm = 0;
  int chosen = 0;
};
Repeated Repeat(unsigned effort) {
  const SensorModel model = test::GoldenSensor(16, 256);
  RangeSettings settings;
  settings.coder = RangeCoder::kMixing;
  settings.effort = effort;
  settings.grid = RangeGrid(1, 41);
  RangeEncoder encoder(model);
  RangeDecoder decoder(model);
  BlockStore store;
  BlockLink link;
  Repeated r;
  for (const RangeImage& scan : NoisyScans(8)) {
    std::vector<std::uint8_t> bytes;
    EXPECT_TRUE(encoder.Encode(scan, settings, &bytes, &link));
    if (link.reference) r.bytes += bytes.size();
    link.reference = std::move(link.left);
    ByteReader reader(bytes.data(), bytes.size());
    RangeImage back;
    IntensityScale scale;
    EXPECT_TRUE(decoder.Decode(&reader, 1U << 20, &back, &scale, &store));
    EXPECT_EQ(decoder.error_m(), 0.02);
    if (decoder.header().grid.parts() < settings.grid.parts()) ++r.chosen;
    for (std::size_t i = 0; i < back.size(); ++i)
      r.error_mm = std::max(r.error_mm, std::abs(static_cast<int>(back.ranges[i]) -
                                                 static_cast<int>(scan.ranges[i])));
  }
  return r;
}

TEST(Temporal, BlocksOfTheHighestEffortChooseBinsThatWereSeenWithinTheError) {
  const Repeated plain = Repeat(2);
  const Repeated chosen = Repeat(3);
  EXPECT_EQ(plain.chosen, 0);
  EXPECT_GT(chosen.chosen, 0);
  EXPECT_LE(plain.error_mm, 20);
  EXPECT_LE(chosen.error_mm, 20);
  EXPECT_LT(chosen.bytes, plain.bytes);
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
  const std::size_t most = BlockStore::kMostBytes / sizeof(BlockMemory);
  EXPECT_LE(store.size(), most);
  EXPECT_GE(store.size(), most - 1);           // Blocks without pixels take nearly that size.
  EXPECT_EQ(store.Recall(7, place), nullptr);  // The oldest block was forgotten.
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
