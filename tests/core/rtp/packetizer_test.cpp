// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rtp/packetizer.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <numeric>
#include <string>

#include "src/rtp/fragment_buffer.h"
#include "src/rtp/stream_config.h"
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
      // All packets but the last one are full. Only the last packet has the marker.
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

std::string Hex(const std::vector<std::uint8_t>& bytes) {
  std::string text;
  char digits[3];
  for (const std::uint8_t byte : bytes) {
    std::snprintf(digits, sizeof digits, "%02x", byte);
    text += digits;
  }
  return text;
}

Unit GoldenUnit() {
  Unit unit;
  unit.config_id = 0xC1;
  unit.slice = {0x01020304, 5, 8};
  unit.info = {0x0A0B0C0D, 640, 12'500'000, 0x1122334455667788};
  return unit;
}

/// Returns `size` bytes with the values `first`, `first` + 1, and so on.
std::vector<std::uint8_t> Count(std::size_t size, std::uint8_t first) {
  std::vector<std::uint8_t> bytes(size);
  std::iota(bytes.begin(), bytes.end(), first);
  return bytes;
}

// The bytes below were written by tests/system/adversary/wire.py, which implements only the
// document of the format and shares no code with the project.

TEST(GoldenUnits, AreThoseOfAnotherWriter) {
  const auto bytes = Count(30, 1);
  Unit unit = GoldenUnit();
  EXPECT_EQ(Hex(Payload(Packetize(unit, {bytes.data(), 30}, 1'000)[0], bytes)),
            "02c10000001e5a39149901020304000500080a0b0c0d028000bebc201122334455667788"
            "0102030405060708090a0b0c0d0e0f101112131415161718191a1b1c1d1e");
  unit.unit = UnitType::kSliceAfterSkip;
  unit.info.skipped = 0x8000000000000005;
  EXPECT_EQ(Hex(Payload(Packetize(unit, {bytes.data(), 30}, 1'000)[0], bytes)),
            "03c10000001e8cbc6b3201020304000500080a0b0c0d028000bebc201122334455667788"
            "80000000000000050102030405060708090a0b0c0d0e0f101112131415161718191a1b1c1d1e");
}

TEST(GoldenUnits, InFragmentsAreThoseOfAnotherWriter) {
  const auto bytes = Count(100, 0);
  const auto packets = Packetize(GoldenUnit(), {bytes.data(), 100}, 64);
  ASSERT_EQ(packets.size(), 3U);
  EXPECT_EQ(Hex(Payload(packets[0], bytes)),
            "42c100000064f9747d2801020304000500080a0b0c0d028000bebc201122334455667788"
            "000102030405060708090a0b0c0d0e0f101112131415161718191a1b");
  EXPECT_EQ(Hex(Payload(packets[1], bytes)),
            "62c101020304000500081c1d1e1f202122232425262728292a2b2c2d2e2f3031323334353637"
            "38393a3b3c3d3e3f404142434445464748494a4b4c4d4e4f5051");
  EXPECT_EQ(Hex(Payload(packets[2], bytes)),
            "82c1010203040005000852535455565758595a5b5c5d5e5f60616263");
}

TEST(GoldenUnits, InOnePacketAreThoseOfAnotherWriter) {
  Aggregator aggregator;
  const auto first = Count(30, 1);
  const auto second = Count(1, 7);
  Unit unit = GoldenUnit();
  ASSERT_TRUE(aggregator.Add(unit, {first.data(), 30}, 600, 9'000));
  unit.slice.index = 6;
  ASSERT_TRUE(aggregator.Add(unit, {second.data(), 1}, 600, 9'000 + 1'125));
  EXPECT_EQ(Hex(aggregator.Take()->header),
            "200000004202c10000001e5a39149901020304000500080a0b0c0d028000bebc20112233445566"
            "77880102030405060708090a0b0c0d0e0f101112131415161718191a1b1c1d1e0465002502c100"
            "000001dc8a1b5101020304000600080a0b0c0d028000bebc20112233445566778807");
}

TEST(GoldenUnits, OfAConfigAreThoseOfAnotherWriter) {
  StreamConfig config;
  config.coder = Coder::kDraco;
  config.geometry = Geometry::kXyz;
  config.framerate_n = 10;
  config.framerate_d = 1;
  config.fields = "x:F32:0,y:F32:4,z:F32:8";
  const auto bytes = config.Serialise();
  Unit unit;
  unit.unit = UnitType::kStreamConfig;
  unit.config_id = ConfigId(bytes, std::nullopt);
  EXPECT_EQ(Hex(Payload(Packetize(unit, {bytes.data(), bytes.size()}, 1'000)[0], bytes)),
            "00840000002547f9fb2401000000000a0000000100170000783a4633323a302c793a4633323a34"
            "2c7a3a4633323a38");
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
  EXPECT_EQ(Placed(&scans, 15, 0, 2).slice.scan_number, 1U);  // This source gives no scan ids.
}

TEST(ScanCounter, ASliceThatComesAgainIsOfTheNextScan) {
  ScanCounter scans(7);
  EXPECT_EQ(Placed(&scans, 0, 0, 1).slice.scan_number, 7U);
  const Unit again = Placed(&scans, 0, 0, 1);
  EXPECT_EQ(again.slice.scan_number, 8U);
  EXPECT_EQ(again.unit, UnitType::kSlice);
  EXPECT_EQ(Placed(&scans, 0, 2, 4).slice.scan_number, 8U);
  // Slice 3 of the scan before and slices 0 and 1 of this scan are skipped.
  const Unit later = Placed(&scans, 0, 2, 4);
  EXPECT_EQ(later.slice.scan_number, 9U);
  EXPECT_EQ(later.info.skipped & 0b111U, 0b111U);
}

TEST(ScanCounter, TellsWhichOfTheSlicesBeforeWereLeftOut) {
  ScanCounter scans(0);
  EXPECT_EQ(Placed(&scans, 1, 1, 4).unit, UnitType::kSlice);  // Nothing is known of earlier slices.
  EXPECT_EQ(Placed(&scans, 1, 2, 4).unit, UnitType::kSlice);
  // Slice 3 of the scan before and slice 0 of this scan are skipped.
  const Unit over_the_end = Placed(&scans, 2, 1, 4);
  EXPECT_EQ(over_the_end.unit, UnitType::kSliceAfterSkip);
  EXPECT_EQ(over_the_end.info.skipped, 0b11U);
  EXPECT_EQ(Placed(&scans, 2, 2, 4).info.skipped, 0b110U);
  EXPECT_EQ(Placed(&scans, 2, 3, 4).info.skipped, 0b1100U);
  // Scans that are skipped as a whole have no number.
  EXPECT_EQ(Placed(&scans, 9, 0, 4).info.skipped, 0b11000U);
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
