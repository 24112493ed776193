// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests which slices the encoder remembers as references, and how much memory they take.
#include "src/codec/reference_keeper.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>

#include "src/codec/block_store.h"
#include "src/codec/standstill.h"

namespace lidar::codec {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kOneReceiver = 7;

BlockMemoryPtr Block(std::uint32_t columns) {
  auto block = std::make_shared<BlockMemory>();
  block->beams = 128;
  block->columns = columns;
  block->pixels.resize(std::size_t{128} * columns);
  return block;
}

TEST(ReferenceKeeper, LetsOldSlicesGoWhereTheyAreTooLargeAndRemembersNewOnes) {
  const BlockMemoryPtr block = Block(1024);
  constexpr std::uint32_t kSlices = 8;
  ASSERT_GT(kSlices * ReferenceKeeper::kMostOfSlice * block->bytes(), ReferenceKeeper::kMostBytes);
  ReferenceKeeper keeper;
  for (std::uint32_t scan = 0; scan < 40; ++scan) {
    const Time now{scan * 100ms};
    // The acknowledgement tells that there is a receiver, and that it has no slice yet.
    keeper.OnAcknowledged(now, kOneReceiver, 0, UINT32_MAX);
    for (std::uint32_t index = 0; index < kSlices; ++index) {
      EXPECT_TRUE(keeper.Begin(now, {scan, index, kSlices})) << scan;
      keeper.OnEncoded({block});
      ASSERT_LE(keeper.bytes(), ReferenceKeeper::kMostBytes + block->bytes());
    }
  }
  EXPECT_GT(keeper.bytes(), ReferenceKeeper::kMostBytes / 4);
}

TEST(ReferenceKeeper, ForgetsSlicesThatAreNeverAcknowledgedOnceALaterOneIs) {
  const BlockMemoryPtr block = Block(1024);
  ASSERT_GT(200 * block->bytes(), ReferenceKeeper::kMostBytes);
  ReferenceKeeper keeper;
  keeper.set_key_interval({});
  keeper.OnAcknowledged(Time{0s}, kOneReceiver, 0, UINT32_MAX);
  for (std::uint32_t scan = 1; scan <= 400; ++scan) {
    const Time now{scan * 100ms};
    ASSERT_TRUE(keeper.Begin(now, {scan, 0, 1})) << scan;
    EXPECT_EQ(keeper.HasReference(), scan > 2) << scan;
    keeper.OnEncoded({block});
    if (scan % 2 == 0) keeper.OnAcknowledged(now, kOneReceiver, scan, 0);
    ASSERT_LE(keeper.bytes(), 3 * block->bytes()) << scan;
  }
}

TEST(ReferenceKeeper, HoldsNoMemoryForAReceiverThatIsGone) {
  ReferenceKeeper keeper;
  keeper.OnAcknowledged(Time{0s}, kOneReceiver, 0, UINT32_MAX);
  ASSERT_TRUE(keeper.Begin(Time{0s}, {1, 0, 1}));
  keeper.OnEncoded({Block(64)});
  EXPECT_GT(keeper.bytes(), 0U);
  EXPECT_FALSE(keeper.Begin(Time{3s}, {2, 0, 1}));
  EXPECT_EQ(keeper.bytes(), 0U);
  // A new receiver replaces the first one at once. It has no slice yet.
  keeper.OnAcknowledged(Time{3s}, kOneReceiver + 1, 1, 0);
  EXPECT_TRUE(keeper.Begin(Time{3s}, {3, 0, 1}));
  EXPECT_FALSE(keeper.HasReference());
  keeper.OnEncoded({Block(64)});
  EXPECT_EQ(keeper.bytes(), Block(64)->bytes());
  keeper.OnAcknowledged(Time{3s}, kOneReceiver + 1, 3, 0);
  EXPECT_TRUE(keeper.Begin(Time{3s}, {4, 0, 1}));
  EXPECT_TRUE(keeper.HasReference());
}

TEST(ReferenceKeeper, RefersToNoSliceWhoseNameCameTwice) {
  for (const bool twice : {false, true}) {
    ReferenceKeeper keeper;
    keeper.OnAcknowledged(Time{0s}, kOneReceiver, 0, UINT32_MAX);
    for (int i = 0; i < (twice ? 2 : 1); ++i) {
      ASSERT_TRUE(keeper.Begin(Time{0s}, {5, 0, 1}));
      keeper.OnEncoded({Block(64)});
    }
    keeper.OnAcknowledged(Time{100ms}, kOneReceiver, 5, 0);
    ASSERT_TRUE(keeper.Begin(Time{100ms}, {6, 0, 1}));
    EXPECT_EQ(keeper.HasReference(), !twice);
    EXPECT_EQ(keeper.bytes() > 0, !twice);
  }
}

TEST(ReferenceKeeper, RefersToTheBlockOfTheSamePlace) {
  std::vector<BlockMemoryPtr> blocks;
  for (const std::uint32_t first_column : {0U, 64U}) {
    auto block = std::make_shared<BlockMemory>(*Block(64));
    block->first_column = first_column;
    blocks.push_back(block);
  }
  ReferenceKeeper keeper;
  keeper.OnAcknowledged(Time{0s}, kOneReceiver, 0, UINT32_MAX);
  ASSERT_TRUE(keeper.Begin(Time{0s}, {1, 0, 1}));
  EXPECT_TRUE(keeper.references().empty());
  keeper.OnEncoded(blocks);
  keeper.OnAcknowledged(Time{0s}, kOneReceiver, 1, 0);
  ASSERT_TRUE(keeper.Begin(Time{100ms}, {2, 0, 1}));
  EXPECT_EQ(keeper.references(), blocks);
  const auto reference = [&](std::uint32_t beams, std::uint32_t columns, std::uint32_t first) {
    RangeImage image;
    image.beams = beams;
    image.columns = columns;
    image.first_column = first;
    return keeper.Reference(image);
  };
  EXPECT_EQ(reference(128, 64, 0), blocks[0]);
  EXPECT_EQ(reference(128, 64, 64), blocks[1]);
  EXPECT_EQ(reference(128, 64, 32), nullptr);
  EXPECT_EQ(reference(128, 32, 0), nullptr);
  EXPECT_EQ(reference(64, 64, 0), nullptr);
}

TEST(PixelMemory, AveragesTheRangesNearItsMeanAndBeginsAnewBeyond) {
  constexpr std::int64_t kStep = 328;  // 41 mm
  PixelMemory pixel;
  const auto expect = [&](std::uint32_t range_mm, const std::array<unsigned, 4>& after) {
    pixel.See(range_mm, kStep);
    EXPECT_EQ((std::array<unsigned, 4>{pixel.mean, pixel.spread, pixel.count, pixel.returns}),
              after)
        << range_mm;
  };
  expect(0, {0, 0, 0, 0b0});
  expect(1'000, {8'000, 82, 1, 0b1});
  expect(0, {8'000, 82, 1, 0b10});
  expect(1'020, {8'080, 121, 2, 0b101});
  expect(2'000, {16'000, 82, 1, 0b1011});
  // This is the farthest range that still counts towards the mean of 2 m.
  expect(2'123, {16'492, 533, 2, 0b10111});
  expect(1'000, {8'000, 82, 1, 0b101111});
  for (int i = 0; i < 20; ++i) pixel.See(1'000, kStep);
  EXPECT_EQ(pixel.mean, 8'000U);
  EXPECT_EQ(pixel.count, PixelMemory::kMostCount);
  EXPECT_EQ(pixel.returns, 0xFF);
  PixelMemory wide;
  for (const std::uint32_t range_mm : {200'000U, 300'000U}) wide.See(range_mm, 1'000'000);
  EXPECT_EQ(wide.mean, 2'000'000U);
  EXPECT_EQ(wide.spread, 65'535);
}

TEST(BlockStore, CountsAndForgetsTheBlocksOfEachSectorAlone) {
  struct Sector {
    std::uint32_t beams, columns, first_column;
  };
  BlockStore store;
  std::uint32_t crc = 0;
  for (std::size_t i = 0; i < BlockStore::kMostOfSector + 5; ++i)
    for (const Sector& s :
         {Sector{128, 8, 0}, Sector{128, 8, 8}, Sector{128, 4, 0}, Sector{64, 8, 0}}) {
      auto block = std::make_shared<BlockMemory>();
      block->beams = s.beams;
      block->columns = s.columns;
      block->first_column = s.first_column;
      block->crc = crc++;
      block->pixels.resize(std::size_t{s.beams} * s.columns);
      store.Add(block);
      store.Add(block);  // The same block counts once.
    }
  EXPECT_EQ(store.size(), 4 * BlockStore::kMostOfSector);
  RangeImage place;
  place.beams = 128;
  place.columns = 8;
  place.first_column = 8;
  EXPECT_EQ(store.Recall(1, place), nullptr) << "forgotten";
  EXPECT_EQ(store.Recall(crc - 4, place), nullptr) << "of another sector";
  const BlockMemoryPtr newest = store.Recall(crc - 3, place);
  ASSERT_NE(newest, nullptr);
  EXPECT_EQ(newest->crc, crc - 3);
  EXPECT_EQ(store.size(), 3 * BlockStore::kMostOfSector + BlockStore::kOvertaking + 1);
  place.first_column = 0;
  EXPECT_NE(store.Recall(4 * 5, place), nullptr) << "the oldest that the first sector has";
}

TEST(ReferenceKeeper, KeysComeInTurnAfterTheIntervalHasChanged) {
  constexpr std::uint32_t kSlices = 8;
  ReferenceKeeper keeper;
  keeper.OnAcknowledged(Time{0s}, kOneReceiver, 0, UINT32_MAX);
  std::uint32_t scan = 0;
  // Returns the largest number of slices in one scan that do not refer to another slice.
  const auto most_keys = [&](Duration interval) {
    std::uint32_t most = 0;
    for (int i = 0; i < 40; ++i) {
      const Time now{++scan * 100ms};
      std::uint32_t keys = 0;
      for (std::uint32_t index = 0; index < kSlices; ++index) {
        keeper.set_key_interval(interval);
        EXPECT_TRUE(keeper.Begin(now, {scan, index, kSlices}));
        keys += keeper.HasReference() ? 0U : 1U;
        keeper.OnEncoded({Block(8)});
        keeper.OnAcknowledged(now, kOneReceiver, scan, index);
      }
      most = std::max(most, keys);
    }
    return most;
  };
  EXPECT_EQ(most_keys(2s), kSlices) << "in the first scan";
  EXPECT_EQ(most_keys({}), 0U);
  EXPECT_EQ(most_keys(2s), 1U);
  EXPECT_EQ(most_keys(1s), 1U);
}

TEST(Standstill, ForgetsASourceThatBeginsInMoreColumnsThanASensorHasSectors) {
  RangeImage image;
  image.beams = 8;
  image.columns = 4;
  for (const std::uint32_t range : {5'000U, 9'000U, 5'000U, 9'000U})
    image.ranges.insert(image.ranges.end(), 8, range);
  for (const std::uint32_t sectors : {250U, 260U}) {
    Standstill standstill;
    for (image.first_column = 0; image.first_column < sectors; ++image.first_column)
      EXPECT_FALSE(standstill.OnImage(image, 0.04));
    image.first_column = 0;
    EXPECT_EQ(standstill.OnImage(image, 0.04), sectors == 250);
  }
}

/// The first pixel of a row has no neighbour, because the last pixel of the row above has another
/// azimuth.
TEST(Standstill, ComparesNoPixelWithTheRowAbove) {
  RangeImage image;
  image.beams = 64;
  image.columns = 1;
  image.ranges.assign(64, 5'000);
  Standstill standstill;
  EXPECT_FALSE(standstill.OnImage(image, 0.04));
  for (std::uint32_t& range : image.ranges) range += 160;  // four steps
  EXPECT_TRUE(standstill.OnImage(image, 0.04)) << "that costs less than a return without any";
}

TEST(Standstill, ForgetsASourceOfMoreSectorsThanItHasMemoryFor) {
  RangeImage image;
  image.beams = 64;
  image.columns = 1'024;
  image.ranges.assign(image.size(), 5'000);
  for (std::size_t i = 0; i < image.size(); i += 2) image.ranges[i] = 9'000;
  // The limit is 4 million pixels, which are 64 of these sectors.
  for (const std::uint32_t sectors : {60U, 70U}) {
    Standstill standstill;
    for (image.first_column = 0; image.first_column < sectors; ++image.first_column)
      EXPECT_FALSE(standstill.OnImage(image, 0.04));
    image.first_column = 0;
    EXPECT_EQ(standstill.OnImage(image, 0.04), sectors == 60);
  }
}

}  // namespace
}  // namespace lidar::codec
