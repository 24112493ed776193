// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rtp/packetizer.h"

#include <gtest/gtest.h>

#include "src/rtp/fragment_buffer.h"
#include "tests/core/rtp/stream.h"

namespace lidar::rtp {
namespace {

std::vector<std::uint8_t> Payload(const Packet& p, const std::vector<std::uint8_t>& unit) {
  std::vector<std::uint8_t> bytes = p.header;
  const auto from = unit.begin() + static_cast<std::ptrdiff_t>(p.body_offset);
  bytes.insert(bytes.end(), from, from + static_cast<std::ptrdiff_t>(p.body_size));
  return bytes;
}

class EverySize : public ::testing::TestWithParam<std::size_t> {};

TEST_P(EverySize, GivesPacketsThatFitAndJoinToTheSlice) {
  const std::size_t max_payload = GetParam();
  Unit unit;
  unit.slice = {3, 1, 4};
  for (std::size_t size = 1; size<4 * max_payload + 3; size += max_payload> 200 ? 13 : 1) {
    const auto bytes = test::SliceBytes(3, 1, size);
    const auto packets = Packetize(unit, {bytes.data(), size}, max_payload);
    ASSERT_FALSE(packets.empty());
    FragmentBuffer buffer;
    for (std::size_t i = 0; i < packets.size(); ++i) {
      const auto payload = Payload(packets[i], bytes);
      ASSERT_LE(payload.size(), max_payload);
      // Only the last packet may have room left, and only it has the marker.
      const bool last = i + 1 == packets.size();
      ASSERT_TRUE(last || payload.size() == max_payload);
      ASSERT_EQ(packets[i].marker, last);
      const auto units = ParsePayload({payload.data(), payload.size()});
      ASSERT_EQ(units.size(), 1U) << size << " " << i;
      ASSERT_EQ(buffer.Add(static_cast<std::uint16_t>(65'534 + i), units[0]),
                FragmentBuffer::Added::kStored);
      ASSERT_EQ(buffer.IsWhole(), last);
    }
    ASSERT_EQ(buffer.Join(), bytes);
  }
}
INSTANTIATE_TEST_SUITE_P(Payloads, EverySize,
                         ::testing::Values(kMinPayload, 65, 99, 128, 576, 1188, 1388));

TEST(Packetize, RefusesEmptyAndHugeUnitsAndTinyPayloads) {
  const std::vector<std::uint8_t> bytes(kMaxUnitBytes + 1, 1);
  EXPECT_TRUE(Packetize({}, {bytes.data(), 0}, 1'200).empty());
  EXPECT_TRUE(Packetize({}, {bytes.data(), bytes.size()}, 1'200).empty());
  EXPECT_TRUE(Packetize({}, {bytes.data(), 10}, kMinPayload - 1).empty());
  EXPECT_FALSE(Packetize({}, {bytes.data(), kMaxUnitBytes}, 1'200).empty());
}

TEST(Packetize, GivesConfigsNoMarker) {
  Unit unit;
  unit.unit = UnitType::kStreamConfig;
  const auto bytes = test::SmallConfig().Serialise();
  const auto packets = Packetize(unit, {bytes.data(), bytes.size()}, 80);
  ASSERT_GT(packets.size(), 1U);
  EXPECT_FALSE(packets.back().marker);
}

TEST(Aggregator, PutsSmallSlicesTogetherAndKeepsTheirTimes) {
  Aggregator aggregator;
  const auto a = test::SliceBytes(1, 0, 100);
  const auto b = test::SliceBytes(1, 1, 200);
  Unit unit;
  unit.slice = {1, 0, 2};
  ASSERT_TRUE(aggregator.Add(unit, {a.data(), a.size()}, 600, 9'000));
  unit.slice = {1, 1, 2};
  ASSERT_TRUE(aggregator.Add(unit, {b.data(), b.size()}, 600, 9'000 + 1'125));
  ASSERT_FALSE(aggregator.Add(unit, {b.data(), b.size()}, 600, 9'000 + 2'250));
  const auto packet = aggregator.Take();
  ASSERT_TRUE(packet);
  EXPECT_TRUE(packet->marker);
  EXPECT_LE(packet->header.size(), 600U);
  const auto units = ParsePayload({packet->header.data(), packet->header.size()});
  ASSERT_EQ(units.size(), 2U);
  EXPECT_EQ(units[0].timestamp_ticks, 0);
  EXPECT_EQ(units[1].timestamp_ticks, 1'125);
  EXPECT_EQ(units[1].slice.index, 1);
  EXPECT_TRUE(std::equal(b.begin(), b.end(), units[1].body.begin(), units[1].body.end()));
  EXPECT_TRUE(aggregator.empty());
  EXPECT_FALSE(aggregator.Take());
}

TEST(Aggregator, SendsOneSliceAsASingleUnit) {
  Aggregator aggregator;
  const auto a = test::SliceBytes(1, 0, 100);
  ASSERT_TRUE(aggregator.Add({}, {a.data(), a.size()}, 600, 0));
  const auto packet = aggregator.Take();
  const auto plain = Packetize({}, {a.data(), a.size()}, 600);
  EXPECT_EQ(packet->header, Payload(plain[0], a));
}

TEST(Aggregator, RefusesSlicesFurtherApartThanItCanSay) {
  Aggregator aggregator;
  const auto a = test::SliceBytes(1, 0, 10);
  ASSERT_TRUE(aggregator.Add({}, {a.data(), a.size()}, 600, 100'000));
  EXPECT_FALSE(aggregator.Add({}, {a.data(), a.size()}, 600, 100'000 + 65'536));
  EXPECT_FALSE(aggregator.Add({}, {a.data(), a.size()}, 600, 99'999));
  EXPECT_TRUE(aggregator.Add({}, {a.data(), a.size()}, 600, 100'000 + 65'535));
}

Unit Placed(ScanCounter* scans, std::uint32_t scan_id, std::uint16_t index, std::uint16_t count) {
  Unit unit;
  unit.slice.index = index;
  unit.slice.count = count;
  unit.info.scan_id = scan_id;
  scans->Place(&unit);
  return unit;
}

TEST(ScanCounter, HasNoGapsWhereTheSourceSkipsScansOrRepeatsItsIds) {
  ScanCounter scans(0xFFFF'FFFF);
  EXPECT_EQ(Placed(&scans, 10, 0, 2).slice.scan_number, 0xFFFF'FFFFU);
  EXPECT_EQ(Placed(&scans, 10, 1, 2).slice.scan_number, 0xFFFF'FFFFU);
  EXPECT_EQ(Placed(&scans, 15, 0, 2).slice.scan_number, 0U);
  EXPECT_EQ(Placed(&scans, 15, 1, 2).slice.scan_number, 0U);
  EXPECT_EQ(Placed(&scans, 15, 0, 2).slice.scan_number, 1U);  // a source without scan ids
}

TEST(ScanCounter, TellsWhichOfTheSlicesBeforeWereLeftOut) {
  ScanCounter scans(0);
  EXPECT_EQ(Placed(&scans, 1, 1, 4).unit, UnitType::kSlice);  // what came before is unknown
  EXPECT_EQ(Placed(&scans, 1, 2, 4).unit, UnitType::kSlice);
  const Unit over_the_end = Placed(&scans, 2, 1, 4);  // without slice 3 and slice 0
  EXPECT_EQ(over_the_end.unit, UnitType::kSliceAfterSkip);
  EXPECT_EQ(over_the_end.info.skipped, 0b11U);
  EXPECT_EQ(Placed(&scans, 2, 2, 4).info.skipped, 0b110U);
  EXPECT_EQ(Placed(&scans, 2, 3, 4).info.skipped, 0b1100U);
  EXPECT_EQ(Placed(&scans, 9, 0, 4).info.skipped, 0b11000U);  // whole scans have no number
  EXPECT_EQ(Placed(&scans, 9, 3, 4).info.skipped, 0b1100'0011U);
}

TEST(ScanCounter, RemembersSixtyFourSlices) {
  ScanCounter scans(0);
  Placed(&scans, 1, 0, 200);
  EXPECT_EQ(Placed(&scans, 1, 70, 200).info.skipped, ~std::uint64_t{0});
  for (std::uint16_t i = 71; i < 134; ++i)
    EXPECT_EQ(Placed(&scans, 1, i, 200).unit, UnitType::kSliceAfterSkip) << i;
  EXPECT_EQ(Placed(&scans, 1, 134, 200).unit, UnitType::kSlice);
}

}  // namespace
}  // namespace lidar::rtp
