// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests which pixels become points: limits of the range, which hold for each return, and masks.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>

#include "src/base/byte_writer.h"
#include "src/ouster/mask_image.h"
#include "src/ouster/metadata_writer.h"
#include "src/ouster/packet_writer.h"
#include "src/ouster/point_writer.h"
#include "tests/core/ouster/captures.h"

namespace lidar::ouster {
namespace {

/// The ranges of both returns of the first pixel in a packet. A range of 0 means no return.
struct Ranges {
  std::uint32_t first;
  std::uint32_t second;
};
bool operator==(const Ranges& a, const Ranges& b) {
  return a.first == b.first && a.second == b.second;
}

class RangeLimits : public ::testing::Test {
 protected:
  Ranges Filter(const Ranges& measured) {
    Metadata m = test::LoadMetadata("OS-1-128_v2.3.0_1024x10.json");
    m.format.profile = Profile::kRng19Rfl8Sig16Nir16Dual;
    PacketWriter packet(m.format, {m.init_id, m.serial});
    packet.Begin(1);
    packet.SetColumn(0, {1'000'000'000, 0, true});
    packet.SetPixel({0, 0}, Channel::kRange, measured.first);
    packet.SetPixel({0, 0}, Channel::kRange2, measured.second);
    const auto bytes = packet.Finish();
    PointOptions options;
    options.returns = Return::kBoth;
    options.min_range_m = 2.01;
    options.max_range_m = 10;
    std::string error;
    auto writer = PointWriter::Create(m, options, &error);
    EXPECT_TRUE(writer) << error;
    std::vector<std::uint8_t> points(std::size_t{m.format.beams} * writer->point_step());
    const auto parsed = LidarPacket::Parse({bytes.data(), bytes.size()}, m.format);
    writer->WriteColumn(parsed->Column(0), {points.data(), 1, 0, 1'000'000'000});
    Ranges out{};
    std::memcpy(&out.first, &points[16], 4);
    std::memcpy(&out.second, &points[20], 4);
    return out;
  }
};

TEST_F(RangeLimits, AreThemselvesWithinThem) {
  EXPECT_EQ(Filter({2010, 10'000}), (Ranges{2010, 10'000}));
  EXPECT_EQ(Filter({2009, 10'001}), (Ranges{0, 0}));
}

TEST_F(RangeLimits, HoldForEachReturnByItself) {
  EXPECT_EQ(Filter({5000, 1000}), (Ranges{5000, 0}));
  EXPECT_EQ(Filter({5000, 11'000}), (Ranges{5000, 0}));
  EXPECT_EQ(Filter({1000, 5000}), (Ranges{0, 5000}));
}

TEST(MissingPoints, AreZeroesButForCoordinatesThatAreNoNumbers) {
  const Metadata m = test::LoadMetadata("OS-1-128_v2.3.0_1024x10.json");
  for (const Invalid invalid : {Invalid::kZero, Invalid::kNan}) {
    PointOptions options;
    options.invalid = invalid;
    std::string error;
    const auto writer = PointWriter::Create(m, options, &error);
    ASSERT_TRUE(writer) << error;
    const std::uint32_t step = writer->point_step();
    std::vector<std::uint8_t> points(std::size_t{3} * step, 0x55);
    writer->FillMissing(&points);
    for (std::size_t i = 0; i < points.size(); i += 4) {
      float value = 0;
      std::memcpy(&value, &points[i], sizeof value);
      if (invalid == Invalid::kNan && i % step < 12)
        EXPECT_TRUE(std::isnan(value)) << i;
      else
        EXPECT_EQ(value, 0) << i;
    }
  }
}

/// Returns the azimuths of the first beam's points, from -180 to 180 degrees. In this scan, each
/// range is 20 m.
std::vector<double> AzimuthsWithin(const char* sectors) {
  const Metadata m = test::LoadMetadata("OS-1-128_v2.3.0_1024x10.json");
  const std::uint32_t columns = m.model.columns_per_scan;
  PointOptions options;
  options.sectors = ParseSectors(sectors).value();
  std::string error;
  const auto writer = PointWriter::Create(m, options, &error);
  EXPECT_TRUE(writer) << error;
  const std::uint32_t step = writer->point_step();
  std::vector<std::uint8_t> points(std::size_t{m.format.beams} * columns * step);
  PacketWriter packet(m.format, {m.init_id, m.serial});
  for (std::uint32_t first = 0; first < columns; first += m.format.columns_per_packet) {
    packet.Begin(1);
    for (std::uint32_t i = 0; i < m.format.columns_per_packet; ++i) {
      packet.SetColumn(i, {1'000'000'000, static_cast<std::uint16_t>(first + i), true});
      packet.SetPixel({i, 0}, Channel::kRange, 20'000);
    }
    const auto bytes = packet.Finish();
    const auto parsed = LidarPacket::Parse({bytes.data(), bytes.size()}, m.format);
    for (std::uint32_t i = 0; i < parsed->columns(); ++i)
      writer->WriteColumn(parsed->Column(i), {points.data(), columns, 0, 1'000'000'000});
  }
  std::vector<double> azimuths;
  for (std::uint32_t column = 0; column < columns; ++column) {
    std::array<float, 3> xyz{};
    std::memcpy(xyz.data(), &points[std::size_t{column} * step], sizeof xyz);
    if (xyz[0] != 0 || xyz[1] != 0)
      azimuths.push_back(std::atan2(static_cast<double>(xyz[1]), static_cast<double>(xyz[0])) *
                         180 / M_PI);
  }
  return azimuths;
}

TEST(Sectors, MayContainTheDirectionAhead) {
  // A scan has 1024 columns. 57 of them are within a sector of 20 degrees.
  const auto ahead = AzimuthsWithin("350-10");
  EXPECT_NEAR(static_cast<double>(ahead.size()), 57, 1);
  for (const double azimuth : ahead) EXPECT_LT(std::abs(azimuth), 10.1);
  const auto left_and_ahead = AzimuthsWithin("80-100, 350-10");
  EXPECT_NEAR(static_cast<double>(left_and_ahead.size()), 2 * 57, 2);
  for (const double azimuth : left_and_ahead)
    EXPECT_TRUE(std::abs(azimuth) < 10.1 || std::abs(azimuth - 90) < 10.1) << azimuth;
}

TEST(Sectors, AreFromZeroTo360Degrees) {
  for (const char* good : {"", "0-360", "350-10", " 1.5 - 2 , 3-4"})
    EXPECT_TRUE(ParseSectors(good)) << good;
  for (const char* bad : {"5", "0-361", "361-0", "-5-5", "0-x", "x-0", "0-", "0-9x"})
    EXPECT_FALSE(ParseSectors(bad)) << bad;
}

struct Mask {
  const char* header;
  std::size_t pixels;
  const char* error;
};
class Masks : public ::testing::TestWithParam<Mask> {};
TEST_P(Masks, AreBinaryPgmOfTheSizeOfAScan) {
  const Metadata m = test::LoadMetadata("OS-1-32-G_v2.1.1_1024x10.json");
  const auto& [header, pixels, expected] = GetParam();
  const std::string pgm = header + std::string(pixels, '\xff');
  std::string error;
  const auto mask =
      ParseMaskImage({reinterpret_cast<const std::uint8_t*>(pgm.data()), pgm.size()}, m, &error);
  EXPECT_EQ(mask.has_value(), *expected == '\0');
  EXPECT_EQ(error, expected);
}
constexpr std::size_t kPixels = std::size_t{32} * 1024;
constexpr const char* kNoPgm = "the mask is not a binary PGM image with 8 bits a pixel";
constexpr const char* kNoScan = "the mask must have 1024 x 32 pixels, as the sensor's scans";
INSTANTIATE_TEST_SUITE_P(
    All, Masks,
    ::testing::Values(
        Mask{"P5 1024 32 255\n", kPixels, ""}, Mask{"P5 1024 32 1\n", kPixels, ""},
        Mask{"P5 1024 32 0\n", kPixels, kNoPgm}, Mask{"P5 1024 32 256\n", kPixels, kNoPgm},
        Mask{"P5 1024 32\n", kPixels, kNoPgm}, Mask{"P2 1024 32 255\n", kPixels, kNoPgm},
        Mask{"Q5 1024 32 255\n", kPixels, kNoPgm}, Mask{"P5", 0, kNoPgm},
        Mask{"P5 1024 32 255\n", kPixels - 1, kNoScan}, Mask{"P5 32 1024 255\n", kPixels, kNoScan},
        Mask{"P5 1024 31 255\n", kPixels, kNoScan}, Mask{"P5 512 32 255\n", kPixels, kNoScan}));

TEST(MaskImage, PixelsAreShiftedAsTheBeamsAre) {
  Metadata m = test::LoadMetadata("OS-1-32-G_v2.1.1_1024x10.json");
  const std::uint32_t columns = m.model.columns_per_scan;
  const std::uint32_t beam = 5;
  const auto shift = static_cast<std::uint32_t>(m.model.beams[beam].pixel_shift);
  ASSERT_EQ(shift, 16U);
  const std::string header = "P5 1024 32 255\n";
  std::vector<std::uint8_t> pgm(header.begin(), header.end());
  pgm.resize(header.size() + std::size_t{columns} * m.format.beams);
  // Column 100 is a column of the destaggered image.
  pgm[header.size() + std::size_t{beam} * columns + 100] = 9;
  std::string error;
  const auto mask = ParseMaskImage({pgm.data(), pgm.size()}, m, &error);
  ASSERT_TRUE(mask) << error;
  for (std::uint32_t column = 0; column < columns; ++column)
    EXPECT_EQ((*mask)[std::size_t{beam} * columns + column], column == 100 - shift ? 9 : 0)
        << column;
}

}  // namespace
}  // namespace lidar::ouster
