// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests each profile: parser and batcher must return the values that the writer put into packets.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "src/ouster/lidar_packet.h"
#include "src/ouster/metadata_writer.h"
#include "src/ouster/packet_writer.h"
#include "src/ouster/scan_batcher.h"
#include "tests/core/ouster/captures.h"

namespace lidar::ouster {
namespace {

struct Case {
  Profile profile;
  HeaderType header;
  std::uint32_t pixel_bytes;  // the size of a pixel in the SDK
  std::uint32_t columns = 512;
  std::uint32_t columns_per_packet = 16;
  std::uint32_t beams = 16;
  double scans_per_second = 10;
};

Metadata MakeMetadata(const Case& c) {
  Metadata m;
  m.product_line = "OS-1-" + std::to_string(c.beams);
  m.serial_text = "122201000998";
  m.serial = 122201000998;
  m.firmware = "v3.1.0";
  m.init_id = 7109750;
  m.lidar_mode =
      std::to_string(c.columns) + "x" + std::to_string(static_cast<int>(c.scans_per_second));
  m.timestamp_mode = "TIME_FROM_INTERNAL_OSC";
  m.scans_per_second = c.scans_per_second;
  m.format = {c.profile, c.header, c.beams, c.columns_per_packet};
  m.window = {0, c.columns};
  m.model.columns_per_scan = c.columns;
  m.model.range_unit_mm = m.format.range_unit_mm();
  m.model.beam_to_lidar_x_m = 0.015806;
  m.model.lidar_to_sensor = {-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0.03618, 0, 0, 0, 1};
  m.imu_to_sensor = {1, 0, 0, 0.006253, 0, 1, 0, -0.011775, 0, 0, 1, 0.007645, 0, 0, 0, 1};
  for (std::uint32_t i = 0; i < c.beams; ++i)
    m.model.beams.push_back({i % 2 == 0 ? 1.5 : -1.5, 20.0 - i, static_cast<int>(i % 4)});
  m.lidar_port = 7502;
  m.imu_port = 7503;
  return m;
}

/// Returns the value of a pixel in a channel, which may be any number that the channel can hold.
std::uint32_t ValueOf(const ChannelBits& bits, std::uint32_t beam, std::uint32_t column) {
  std::minstd_rand random(1 + beam * 7919 + column * 31 +
                          static_cast<std::uint32_t>(bits.channel) * 104729);
  random.discard(3);
  const auto mask = (std::uint64_t{1} << bits.bits) - 1;
  return static_cast<std::uint32_t>((random() & mask) << bits.scale_shift);
}

/// Writes the packets of a scan. If `again` is true, all bits of each pixel are set first, so that
/// the writer must replace them.
std::vector<std::vector<std::uint8_t>> WriteScan(const Metadata& m, std::uint32_t frame_id,
                                                 bool again = false) {
  PacketWriter writer(m.format, {m.init_id, m.serial});
  std::vector<std::vector<std::uint8_t>> packets;
  for (std::uint32_t first = 0; first < m.model.columns_per_scan;
       first += m.format.columns_per_packet) {
    writer.Begin(frame_id);
    for (std::uint32_t i = 0; i < m.format.columns_per_packet; ++i) {
      const std::uint32_t column = first + i;
      writer.SetColumn(i, {1'000'000'000ULL + column * 195'312ULL,
                           static_cast<std::uint16_t>(column), column < m.model.columns_per_scan});
      for (std::uint32_t beam = 0; again && beam < m.format.beams; ++beam)
        for (const ChannelBits& bits : LayoutOf(m.format.profile))
          writer.SetPixel({i, beam}, bits.channel, 0xFFFF'FFFFU);
      for (std::uint32_t beam = 0; beam < m.format.beams; ++beam)
        for (const ChannelBits& bits : LayoutOf(m.format.profile))
          writer.SetPixel({i, beam}, bits.channel, ValueOf(bits, beam, column));
    }
    packets.push_back(writer.Finish());
  }
  return packets;
}

class Profiles : public ::testing::TestWithParam<Case> {};

TEST_P(Profiles, EveryChannelSurvivesWritingAndParsing) {
  const Metadata m = MakeMetadata(GetParam());
  ASSERT_EQ(m.format.pixel_size(), GetParam().pixel_bytes);
  std::uint32_t expected = 0;
  for (const auto& bytes : WriteScan(m, 70000)) {
    const auto packet = LidarPacket::Parse({bytes.data(), bytes.size()}, m.format);
    ASSERT_TRUE(packet);
    EXPECT_EQ(packet->header().frame_id, 70000 % m.format.frame_id_modulus());
    if (!m.format.is_legacy()) {
      EXPECT_EQ(packet->header().type, 1U);
      EXPECT_EQ(packet->header().init_id, m.init_id);
      EXPECT_EQ(packet->header().serial, m.serial);
    }
    for (std::uint32_t i = 0; i < packet->columns(); ++i, ++expected) {
      const PacketColumn column = packet->Column(i);
      ASSERT_EQ(column.measurement_id, expected);
      ASSERT_EQ(column.timestamp, 1'000'000'000ULL + expected * 195'312ULL);
      ASSERT_EQ(column.valid(), expected < m.model.columns_per_scan);
      for (const ChannelBits& bits : LayoutOf(m.format.profile)) {
        const ChannelReader reader(bits);
        for (std::uint32_t beam = 0; beam < m.format.beams; ++beam)
          ASSERT_EQ(reader.Read(column.pixels + beam * m.format.pixel_size()),
                    ValueOf(bits, beam, expected))
              << ToString(bits.channel) << " beam " << beam << " column " << expected;
      }
    }
  }
}

TEST_P(Profiles, APacketThatIsCutHasNoHeaderOrNoColumns) {
  const Metadata m = MakeMetadata(GetParam());
  const auto packet = WriteScan(m, 5).front();
  const std::size_t header_size = m.format.packet_header_size();
  for (std::size_t size = 0; size < packet.size(); size += size < header_size ? 1 : 97) {
    const ByteView cut{packet.data(), size};
    const auto header = PeekHeader(cut, m.format);
    EXPECT_EQ(header.has_value(), !m.format.is_legacy() && size >= header_size) << size;
    EXPECT_FALSE(LidarPacket::Parse(cut, m.format)) << size;
    if (!header) continue;
    EXPECT_EQ(header->frame_id, 5U);
    EXPECT_EQ(header->init_id, m.init_id);
    EXPECT_EQ(header->serial, m.serial);
  }
}

TEST_P(Profiles, APixelThatIsSetAgainHasItsNewValue) {
  const Metadata m = MakeMetadata(GetParam());
  EXPECT_EQ(WriteScan(m, 1, true), WriteScan(m, 1));
}

TEST_P(Profiles, TheBatcherPutsRangesWhereTheyBelong) {
  const Metadata m = MakeMetadata(GetParam());
  std::string error;
  PointOptions options;
  if (m.format.has_second_return()) options.returns = Return::kBoth;
  auto writer = PointWriter::Create(m, options, &error);
  ASSERT_TRUE(writer) << error;
  const std::uint32_t step = writer->point_step();
  ScanBatcher batcher(m, *std::move(writer), {4, 4});
  for (const auto& bytes : WriteScan(m, 1))
    batcher.Push(*LidarPacket::Parse({bytes.data(), bytes.size()}, m.format));
  const auto* bits = LayoutOf(m.format.profile).Find(Channel::kRange);
  const auto* second = LayoutOf(m.format.profile).Find(Channel::kRange2);
  for (std::uint32_t s = 0; s < batcher.slices_per_scan(); ++s) {
    const auto slice = batcher.Pop();
    ASSERT_TRUE(slice);
    EXPECT_EQ(slice->missing_columns, 0U);
    for (std::uint32_t beam = 0; beam < m.format.beams; ++beam) {
      for (std::uint32_t i = 0; i < slice->width; ++i) {
        const std::uint8_t* point = &slice->points[(beam * slice->width + i) * step];
        std::uint32_t range = 0;
        std::memcpy(&range, point + 16, sizeof range);
        ASSERT_EQ(range, ValueOf(*bits, beam, slice->first_column + i));
        if (second == nullptr) continue;
        std::memcpy(&range, point + 20, sizeof range);
        ASSERT_EQ(range, ValueOf(*second, beam, slice->first_column + i));
      }
    }
  }
  EXPECT_FALSE(batcher.Pop());
}

TEST_P(Profiles, TheMetadataSurvivesItsJson) {
  const Metadata m = MakeMetadata(GetParam());
  std::string error;
  const auto back = ParseMetadata(WriteMetadata(m), &error);
  ASSERT_TRUE(back) << error;
  EXPECT_TRUE(SameGeometry(m, *back));
  EXPECT_EQ(back->serial, m.serial);
  EXPECT_EQ(back->init_id, m.init_id);
  EXPECT_EQ(back->timestamp_mode, m.timestamp_mode);
  EXPECT_EQ(back->format.header, m.format.header);
}

TEST_P(Profiles, ADamagedPacketIsToldByItsCrcWhereItHasOne) {
  const Metadata m = MakeMetadata(GetParam());
  auto packets = WriteScan(m, 1);
  PacketCrcCheck check(m.format);
  EXPECT_TRUE(check.Accept({packets[0].data(), packets[0].size()}));
  packets[1][packets[1].size() / 2] ^= 1;
  const bool has_crc = !m.format.is_legacy() && !m.format.is_fusa();
  EXPECT_EQ(check.Accept({packets[1].data(), packets[1].size()}), !has_crc);
  EXPECT_TRUE(check.Accept({packets[2].data(), packets[2].size()}));
}

constexpr HeaderType kStd = HeaderType::kStandard;
INSTANTIATE_TEST_SUITE_P(
    All, Profiles,
    ::testing::Values(
        Case{Profile::kLegacy, kStd, 12}, Case{Profile::kRng19Rfl8Sig16Nir16, kStd, 12},
        Case{Profile::kRng19Rfl8Sig16Nir16Dual, kStd, 16}, Case{Profile::kRng15Rfl8Nir8, kStd, 4},
        Case{Profile::kRng15Rfl8Nir8Dual, kStd, 8},
        Case{Profile::kFusaRng15Rfl8Nir8Dual, HeaderType::kFusa, 8},
        Case{Profile::kRng15Rfl8Win8, kStd, 4}, Case{Profile::kRng15Rfl8Nir8Zone16, kStd, 8},
        Case{Profile::kRng19Rfl8Sig16Nir16Zone16, kStd, 12},
        Case{Profile::kRng19Rfl8Sig16Zone16Dual, kStd, 16},
        Case{Profile::kRng19Rfl8Sig16Nir16Rgb16, kStd, 16},
        Case{Profile::kRng19Rfl8Sig16Nir16Rgb16Dual, kStd, 20},
        Case{Profile::kFiveWordPixel, kStd, 20},
        Case{Profile::kRng19Rfl8Sig16Nir16, HeaderType::kFusa, 12},
        Case{Profile::kRng19Rfl8Sig16Nir16, kStd, 12, 1024, 8, 128, 20},
        Case{Profile::kRng15Rfl8Nir8, kStd, 4, 2048, 16, 32, 10},
        Case{Profile::kRng19Rfl8Sig16Nir16, kStd, 12, 4096, 16, 16, 5},
        Case{Profile::kLegacy, kStd, 12, 1024, 1, 16, 20},
        Case{Profile::kRng15Rfl8Nir8, kStd, 4, 512, 24, 32, 10}));

TEST(Profiles, AllOfThemAreTested) {
  // The profile OFF is one of these profiles, but has no packets.
  EXPECT_EQ(kProfileCount, 14U);
  EXPECT_EQ(LayoutOf(Profile::kOff).count, 0U);
  EXPECT_EQ((PacketFormat{Profile::kOff, kStd, 64, 16}.packet_size()), 0U);
  EXPECT_FALSE(ProfileFromString("RNG42"));
}

TEST(Crc, TheSensorsOwnIsChecked) {
  const Metadata m = test::LoadMetadata("crc_test.json");
  auto packets = test::LoadPackets("crc_test.pcap", m);
  PacketCrcCheck check(m.format);
  for (const auto& p : packets) ASSERT_TRUE(check.Accept({p.data(), p.size()}));
  packets[0][1000] ^= 1;
  EXPECT_FALSE(check.Accept({packets[0].data(), packets[0].size()}));
}

TEST(Crc, IsGivenUpAfterSixtyFourPacketsWithoutOne) {
  const Metadata m = test::LoadMetadata("crc_test.json");
  const auto good = test::LoadPackets("crc_test.pcap", m).at(0);
  auto bad = good;
  bad[1000] ^= 1;
  for (const int before : {63, 64}) {
    PacketCrcCheck check(m.format);
    for (int i = 0; i < before; ++i) EXPECT_TRUE(check.Accept({bad.data(), bad.size()}));
    EXPECT_TRUE(check.Accept({good.data(), good.size()}));
    EXPECT_EQ(check.Accept({bad.data(), bad.size()}), before == 64);
  }
}

TEST(Crc, TheConstantOfOldFirmwareIsNoDamage) {
  const Metadata m = test::LoadMetadata("OS-1-128_v2.3.0_1024x10.json");
  PacketCrcCheck check(m.format);
  for (const auto& p : test::LoadPackets("OS-1-128_v2.3.0_1024x10_lb_n3.pcap", m))
    ASSERT_TRUE(check.Accept({p.data(), p.size()}));
}

}  // namespace
}  // namespace lidar::ouster
