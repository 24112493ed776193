// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rtp/unit_check.h"

#include <gtest/gtest.h>

namespace lidar::rtp {
namespace {

/// Returns the payloads of a slice that has `packets` fragments.
std::vector<std::vector<std::uint8_t>> Fragments(std::size_t packets) {
  const std::vector<std::uint8_t> bytes(100 * packets, 42);
  Unit unit;
  unit.length = static_cast<std::uint32_t>(bytes.size());
  unit.crc = UnitCrc(unit, {bytes.data(), bytes.size()});
  std::vector<std::vector<std::uint8_t>> payloads;
  for (std::size_t i = 0; i < packets; ++i) {
    unit.type = packets == 1       ? PacketType::kSingle
                : i == 0           ? PacketType::kFirstFragment
                : i + 1 == packets ? PacketType::kLastFragment
                                   : PacketType::kMiddleFragment;
    payloads.emplace_back();
    WriteHeader(unit, &payloads.back());
    payloads.back().insert(payloads.back().end(), bytes.begin(), bytes.begin() + 100);
  }
  return payloads;
}

ByteView View(const std::vector<std::uint8_t>& bytes) { return {bytes.data(), bytes.size()}; }

TEST(UnitCheck, FindsAWholeSliceInOneOrMorePackets) {
  for (std::size_t packets : {1U, 2U, 7U}) {
    UnitCheck check;
    std::uint16_t seq = 65534;  // The sequence numbers wrap.
    std::size_t sent = 0;
    for (const auto& payload : Fragments(packets))
      EXPECT_EQ(check.Push(seq++, View(payload)), ++sent == packets);
  }
}

TEST(UnitCheck, RefusesASliceWithAnyBitWrongInItsBytes) {
  const auto whole = Fragments(1).front();
  for (std::size_t bit = 8 * (whole.size() - 100); bit < 8 * whole.size(); ++bit) {
    auto damaged = whole;
    damaged[bit / 8] = static_cast<std::uint8_t>(damaged[bit / 8] ^ 1U << bit % 8);
    EXPECT_FALSE(UnitCheck().Push(0, View(damaged))) << bit;
  }
}

TEST(UnitCheck, TakesNoPartOfASliceTwice) {
  UnitCheck check;
  const auto payloads = Fragments(3);
  EXPECT_FALSE(check.Push(0, View(payloads[0])));
  EXPECT_FALSE(check.Push(1, View(payloads[1])));
  EXPECT_FALSE(check.Push(1, View(payloads[1])));
  EXPECT_FALSE(check.Push(2, View(payloads[2])));
  EXPECT_FALSE(check.Push(3, View(payloads[2])));
}

TEST(UnitCheck, TakesNoSliceWithAGapInItsPacketNumbersHoweverWellItFits) {
  UnitCheck check;
  const auto payloads = Fragments(3);
  EXPECT_FALSE(check.Push(0, View(payloads[0])));
  EXPECT_FALSE(check.Push(2, View(payloads[1])));
  EXPECT_FALSE(check.Push(3, View(payloads[2])));
}

TEST(UnitCheck, AnEndWithoutABeginningProvesNothing) {
  UnitCheck check;
  const auto payloads = Fragments(2);
  EXPECT_TRUE(check.Push(0, View(Fragments(1)[0])));
  EXPECT_FALSE(check.Push(1, View(payloads[1])));
  EXPECT_FALSE(check.Push(2, View(payloads[0])));
  EXPECT_TRUE(check.Push(3, View(payloads[1])));
}

TEST(UnitCheck, AConfigProvesNothingAndEndsTheSliceBefore) {
  Unit config;
  config.type = PacketType::kSingle;
  config.unit = UnitType::kStreamConfig;
  config.length = 4;
  std::vector<std::uint8_t> payload;
  const std::vector<std::uint8_t> bytes(4, 42);
  config.crc = UnitCrc(config, {bytes.data(), bytes.size()});
  WriteHeader(config, &payload);
  payload.insert(payload.end(), bytes.begin(), bytes.end());
  UnitCheck check;
  const auto slice = Fragments(2);
  EXPECT_FALSE(check.Push(0, View(slice[0])));
  EXPECT_FALSE(check.Push(1, View(payload)));
  EXPECT_FALSE(check.Push(1, View(slice[1])));
}

TEST(UnitCheck, AGapEndsASliceAndTheNextOneHasItsChance) {
  UnitCheck check;
  const auto payloads = Fragments(3);
  check.Push(0, View(payloads[0]));
  EXPECT_FALSE(check.Push(2, View(payloads[2])));
  EXPECT_FALSE(check.Push(3, View(payloads[0])));
  EXPECT_FALSE(check.Push(4, View(payloads[1])));
  EXPECT_TRUE(check.Push(5, View(payloads[2])));
}

TEST(UnitCheck, KeepsNoMoreThanASliceMayHold) {
  UnitCheck check;
  Unit unit;
  unit.type = PacketType::kFirstFragment;
  unit.length = 10;
  std::vector<std::uint8_t> first;
  WriteHeader(unit, &first);
  first.insert(first.end(), 50, 0);  // The packet has more bytes than `unit.length`.
  EXPECT_FALSE(check.Push(0, View(first)));
  EXPECT_FALSE(check.Push(1, View(Fragments(2)[1])));
}

TEST(UnitCheck, ASliceThatOutgrowsItsLengthIsNone) {
  UnitCheck check;
  const std::vector<std::uint8_t> bytes(150, 42);
  Unit unit;
  unit.length = static_cast<std::uint32_t>(bytes.size());
  unit.crc = UnitCrc(unit, View(bytes));
  std::uint16_t seq = 0;
  // The middle fragment has bytes too many. Without it, the slice would be complete.
  for (const auto& [type, size] :
       {std::pair(PacketType::kFirstFragment, 100), std::pair(PacketType::kMiddleFragment, 100),
        std::pair(PacketType::kLastFragment, 50)}) {
    unit.type = type;
    std::vector<std::uint8_t> payload;
    WriteHeader(unit, &payload);
    payload.insert(payload.end(), bytes.begin(), bytes.begin() + size);
    EXPECT_FALSE(check.Push(seq++, View(payload))) << size;
  }
}

TEST(UnitCheck, GarbageProvesNothing) {
  UnitCheck check;
  for (std::uint16_t i = 0; i < 1000; ++i)
    EXPECT_FALSE(
        check.Push(i, View(std::vector<std::uint8_t>(i % 90, static_cast<std::uint8_t>(i)))));
}

}  // namespace
}  // namespace lidar::rtp
