// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rtp/payload_header.h"

#include <gtest/gtest.h>

#include <set>

#include "src/rtp/ntp_time.h"
#include "src/rtp/stream_config.h"
#include "tests/core/rtp/stream.h"

namespace lidar::rtp {
namespace {

Unit FirstOfASlice() {
  Unit u;
  u.type = PacketType::kFirstFragment;
  u.config_id = 0xC1;
  u.slice = {0x01020304, 5, 8};
  u.info = {0x0A0B0C0D, 640, 12'500'000, 0x1122334455667788};
  u.length = 5'000;
  u.crc = 0xDEADBEEF;
  return u;
}

TEST(PayloadHeader, StandsOnTheWireAsDocumented) {
  std::vector<std::uint8_t> bytes;
  WriteHeader(FirstOfASlice(), &bytes);
  const std::vector<std::uint8_t> expected = {
      0x42, 0xC1,                                      // first fragment of a slice, config
      0x00, 0x00, 0x13, 0x88, 0xDE, 0xAD, 0xBE, 0xEF,  // length, CRC
      0x01, 0x02, 0x03, 0x04, 0x00, 0x05, 0x00, 0x08,  // scan number, index, count
      0x0A, 0x0B, 0x0C, 0x0D, 0x02, 0x80,              // scan id, first column
      0x00, 0xBE, 0xBC, 0x20,                          // duration
      0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88,  // capture time
  };
  EXPECT_EQ(bytes, expected);
  EXPECT_EQ(bytes.size(), HeaderSize(PacketType::kFirstFragment, UnitType::kSlice));
  bytes.clear();
  Unit middle = FirstOfASlice();
  middle.type = PacketType::kMiddleFragment;
  WriteHeader(middle, &bytes);
  EXPECT_EQ(bytes, (std::vector<std::uint8_t>{0x62, 0xC1, 1, 2, 3, 4, 0, 5, 0, 8}));
}

TEST(PayloadHeader, IsReadBackAsWritten) {
  std::vector<std::uint8_t> bytes;
  WriteHeader(FirstOfASlice(), &bytes);
  bytes.push_back(0xAA);
  const auto units = ParsePayload({bytes.data(), bytes.size()});
  ASSERT_EQ(units.size(), 1U);
  const Unit& u = units[0];
  EXPECT_EQ(u.type, PacketType::kFirstFragment);
  EXPECT_EQ(u.config_id, 0xC1);
  EXPECT_EQ(u.slice.scan_number, 0x01020304U);
  EXPECT_EQ(u.info.first_column, 640);
  EXPECT_EQ(u.info.capture_ntp, 0x1122334455667788U);
  EXPECT_EQ(u.crc, 0xDEADBEEFU);
  ASSERT_EQ(u.body.size, 1U);
  EXPECT_EQ(u.body.data[0], 0xAA);
}

TEST(UnitCrc, CoversEveryBitOfTheMaskOfSlicesLeftOut) {
  const std::vector<std::uint8_t> body(100, 0x55);
  Unit unit = FirstOfASlice();
  unit.unit = UnitType::kSliceAfterSkip;
  unit.info.skipped = 1;
  std::set<std::uint32_t> seen{UnitCrc(unit, {body.data(), body.size()})};
  for (unsigned bit = 1; bit < 64; ++bit) {
    unit.info.skipped = 1 | std::uint64_t{1} << bit;
    EXPECT_TRUE(seen.insert(UnitCrc(unit, {body.data(), body.size()})).second) << bit;
  }
}

TEST(PayloadHeader, OfEveryKindIsRefusedWhenTruncated) {
  for (const UnitType unit :
       {UnitType::kSlice, UnitType::kSliceAfterSkip, UnitType::kStreamConfig}) {
    for (const PacketType type : {PacketType::kSingle, PacketType::kFirstFragment,
                                  PacketType::kMiddleFragment, PacketType::kLastFragment}) {
      Unit u = FirstOfASlice();
      u.type = type;
      u.unit = unit;
      u.length = type == PacketType::kSingle ? 1 : 2;
      std::vector<std::uint8_t> bytes;
      WriteHeader(u, &bytes);
      EXPECT_EQ(bytes.size(), HeaderSize(type, unit));
      bytes.push_back(1);
      EXPECT_EQ(ParsePayload({bytes.data(), bytes.size()}).size(), 1U);
      for (std::size_t n = 0; n < bytes.size(); ++n)
        EXPECT_TRUE(ParsePayload({bytes.data(), n}).empty()) << n;
    }
  }
}

struct Hostile {
  const char* what;
  std::vector<std::uint8_t> bytes;
};
class HostilePayload : public ::testing::TestWithParam<Hostile> {};
TEST_P(HostilePayload, IsRefused) {
  const auto& bytes = GetParam().bytes;
  EXPECT_TRUE(ParsePayload({bytes.data(), bytes.size()}).empty()) << GetParam().what;
}
INSTANTIATE_TEST_SUITE_P(
    All, HostilePayload,
    ::testing::Values(
        Hostile{"empty", {}}, Hostile{"reserved packet type", {0xA2, 0, 0, 0, 0, 0, 0, 0, 0, 1, 7}},
        Hostile{"unknown unit type", {0x64, 0, 0, 0, 0, 0, 0, 0, 0, 1, 7}},
        Hostile{"index equals count", {0x62, 0, 0, 0, 0, 0, 0, 4, 0, 4, 7}},
        Hostile{"no slices", {0x62, 0, 0, 0, 0, 0, 0, 0, 0, 0, 7}},
        Hostile{"too many slices", {0x62, 0, 0, 0, 0, 0, 0, 0, 0x10, 1, 7}},
        Hostile{"a unit of 4 GB", {0x40, 0, 0xFF, 0xFF, 0xFF, 0xFF, 0, 0, 0, 0, 7}},
        Hostile{"a single unit of another length", {0x00, 0, 0, 0, 0, 2, 0, 0, 0, 0, 7}},
        Hostile{"a first fragment that is all", {0x40, 0, 0, 0, 0, 1, 0, 0, 0, 0, 7}},
        Hostile{"an aggregate with a unit type",
                {0x22, 0, 0, 0, 11, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 7}},
        Hostile{"an aggregate of a fragment", {0x20, 0, 0, 0, 3, 0x60, 0, 7}},
        Hostile{"an aggregate in an aggregate", {0x20, 0, 0, 0, 3, 0x20, 0, 7}},
        Hostile{"an aggregate whose unit is longer than it", {0x20, 0, 0, 0, 99, 0, 0, 7}},
        Hostile{"an aggregate with a byte too many",
                {0x20, 0, 0, 0, 11, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 7, 0}}));

TEST(PayloadHeader, TakesAsManySlicesAsAScanMayHave) {
  const std::vector<std::uint8_t> last = {0x62, 0, 0, 0, 0, 0, 0x0F, 0xFF, 0x10, 0, 7};
  const auto units = ParsePayload({last.data(), last.size()});
  ASSERT_EQ(units.size(), 1U);
  EXPECT_EQ(units[0].slice.index, 4095);
  EXPECT_EQ(units[0].slice.count, 4096);
}

TEST(PayloadHeader, OfAnAggregateIsRefusedWhereItsSlicesAreOfSeveralScans) {
  for (const std::uint32_t second : {7U, 8U}) {
    std::vector<std::uint8_t> bytes = {0x20};
    for (const std::uint32_t scan : {7U, second}) {
      Unit u = FirstOfASlice();
      u.type = PacketType::kSingle;
      u.slice.scan_number = scan;
      u.length = 1;
      bytes.insert(bytes.end(), {0, 0, 0, 37});
      WriteHeader(u, &bytes);
      bytes.push_back(9);
    }
    EXPECT_EQ(ParsePayload({bytes.data(), bytes.size()}).size(), second == 7 ? 2U : 0U);
  }
}

TEST(NtpTime, KeepsEveryNanosecondAndCrossesTheEra) {
  for (const std::uint64_t ns :
       {std::uint64_t{1}, std::uint64_t{1'764'000'000'123'456'789}, std::uint64_t{999'999'999},
        std::uint64_t{2'085'978'496'000'000'001}, std::uint64_t{4'000'000'000'000'000'007}}) {
    EXPECT_EQ(FromNtp(ToNtp(ns)), ns);
  }
  EXPECT_EQ(ToNtp(0) >> 32, 2'208'988'800U);
}

TEST(StreamConfig, RoundTrips) {
  const StreamConfig config = test::SmallConfig();
  const auto bytes = config.Serialise();
  const auto back = StreamConfig::Parse({bytes.data(), bytes.size()});
  ASSERT_TRUE(back);
  EXPECT_EQ(*back, config);
}

TEST(StreamConfig, IsRefusedWhenTruncatedOrExtended) {
  auto bytes = test::SmallConfig().Serialise();
  for (std::size_t n = 0; n < bytes.size(); ++n)
    EXPECT_FALSE(StreamConfig::Parse({bytes.data(), n})) << n;
  bytes.push_back(0);
  EXPECT_FALSE(StreamConfig::Parse({bytes.data(), bytes.size()}));
}

TEST(StreamConfig, IsRefusedWhenAnyPartIsUnusable) {
  const auto refused = [](void (*spoil)(StreamConfig*)) {
    StreamConfig c = test::SmallConfig();
    spoil(&c);
    const auto bytes = c.Serialise();
    return !StreamConfig::Parse({bytes.data(), bytes.size()});
  };
  EXPECT_TRUE(refused([](StreamConfig* c) { c->fields = "x:F99:0"; }));
  EXPECT_TRUE(refused([](StreamConfig* c) { c->sensor_model[0] = 77; }));
  // Range geometry needs a sensor model.
  EXPECT_TRUE(refused([](StreamConfig* c) { c->sensor_model.clear(); }));
  EXPECT_TRUE(refused([](StreamConfig* c) { c->framerate_d = 0; }));
  EXPECT_TRUE(refused([](StreamConfig* c) { c->framerate_n = 0x8000'0000; }));
  EXPECT_TRUE(refused([](StreamConfig* c) { c->geometry = static_cast<Geometry>(2); }));
  auto bytes = test::SmallConfig().Serialise();
  bytes[0] = 2;
  EXPECT_FALSE(StreamConfig::Parse({bytes.data(), bytes.size()}));
}

class UndecodableFields : public ::testing::TestWithParam<const char*> {};
TEST_P(UndecodableFields, AreRefusedWhereTheyArrive) {
  StreamConfig c = test::SmallConfig();
  c.fields = GetParam();
  const auto bytes = c.Serialise();
  EXPECT_FALSE(StreamConfig::Parse({bytes.data(), bytes.size()}));
}
INSTANTIATE_TEST_SUITE_P(
    All, UndecodableFields,
    ::testing::Values("range:U32:0", "x:F64:0,y:F64:8,z:F64:16", "x:F32:0,y:F32:8,z:F32:4",
                      "x:F32:0,y:F32:4,z:F32:8,range:U32:8",       // overlaps z
                      "x:F32:0,y:F32:4,z:F32:8,intensity:F32:11",  // overlaps the end of z
                      "x:F32:0,y:F32:4,z:F32:8,range:U32:1016",    // a gap that no decoder fills
                      "x:F32:4,y:F32:8,z:F32:12", "x:F32:0,y:F32:4,z:I32:8"));

TEST(StreamConfig, SaysWhichCoderMadeTheSlices) {
  StreamConfig config = test::SmallConfig();
  const auto of_draco = config.Serialise();
  config.coder = Coder::kLidar;
  const auto of_lidar = config.Serialise();
  EXPECT_EQ(of_draco[1], 0x01);  // the value from the time when Draco was the only coder
  EXPECT_EQ(of_lidar[1], 0x11);
  EXPECT_EQ(StreamConfig::Parse({of_lidar.data(), of_lidar.size()}), config);
  EXPECT_NE(StreamConfig::Parse({of_draco.data(), of_draco.size()}), config);
  EXPECT_NE(ConfigId(of_lidar, std::nullopt), ConfigId(of_draco, std::nullopt));
}

TEST(StreamConfig, IsRefusedOfACoderThatNobodyHas) {
  for (const int coder_and_geometry : {0x20, 0xF1, 0x12}) {
    auto bytes = test::SmallConfig().Serialise();
    bytes[1] = static_cast<std::uint8_t>(coder_and_geometry);
    EXPECT_FALSE(StreamConfig::Parse({bytes.data(), bytes.size()})) << coder_and_geometry;
  }
}

std::optional<StreamConfig> ParseNamed(const std::string& text) {
  std::vector<std::uint8_t> bytes = {1, 255};
  bytes.insert(bytes.end(), text.begin(), text.end());
  return StreamConfig::Parse({bytes.data(), bytes.size()});
}

TEST(StreamConfig, OfACoderWithoutANumberNamesItsCaps) {
  const auto config = ParseNamed("application/x-voxels, alignment=(string)slice, levels=(uint)7");
  ASSERT_TRUE(config);
  EXPECT_EQ(config->coder, Coder::kNamed);
  EXPECT_EQ(config->caps.media_type, "application/x-voxels");
  EXPECT_EQ(*config->caps.Find("levels"), ScalarCaps::Value(7U));
  const auto bytes = config->Serialise();
  EXPECT_EQ(bytes[0], 1);
  EXPECT_EQ(bytes[1], 255);
  EXPECT_EQ(StreamConfig::Parse({bytes.data(), bytes.size()}), config);
  EXPECT_FALSE(*config == test::SmallConfig());
  EXPECT_FALSE(*config ==
               ParseNamed("application/x-voxels, alignment=(string)slice, levels=(uint)8"));
}

class OtherNamedCaps : public ::testing::TestWithParam<const char*> {};
TEST_P(OtherNamedCaps, AreRefused) { EXPECT_FALSE(ParseNamed(GetParam())); }
INSTANTIATE_TEST_SUITE_P(
    All, OtherNamedCaps,
    ::testing::Values("", "video/x-raw, alignment=(string)slice", "application/x-voxels",
                      "application/x-voxels, alignment=(string)scan",
                      "application/x-voxels, alignment=(int)1",
                      "application/x-voxels, alignment=(string)slice, a=(int)[ 1, 2 ]",
                      "application/x-voxels, alignment=(string)slice, fields=(string)\"x:F32:0\"",
                      "application/x-draco, alignment=(string)slice",
                      "application/x-lidar-slice, alignment=(string)slice",
                      "application/x-pointcloud2, alignment=(string)slice",
                      "application/x-imu, alignment=(string)slice",
                      "application/x-odometry, alignment=(string)slice",
                      "application/x-tf, alignment=(string)slice"));

TEST(ConfigId, ComesFromTheContentAndNeverRepeatsForAnother) {
  const auto a = test::SmallConfig().Serialise();
  const std::uint8_t id = ConfigId(a, std::nullopt);
  EXPECT_EQ(ConfigId(a, std::nullopt), id);
  EXPECT_NE(ConfigId(a, id), id);
}

}  // namespace
}  // namespace lidar::rtp
