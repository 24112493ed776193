// SPDX-License-Identifier: LGPL-2.1-or-later
// Which pixels become points: limits of the range, for each return, and masks.
#include <gtest/gtest.h>

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

/// Ranges of the first pixel of a packet that has both returns, as they leave the writer; 0: none.
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

TEST(MaskImage, PixelsAreShiftedAsTheBeamsAre) {
  Metadata m = test::LoadMetadata("OS-1-32-G_v2.1.1_1024x10.json");
  const std::uint32_t columns = m.model.columns_per_scan;
  const std::uint32_t beam = 5;
  const auto shift = static_cast<std::uint32_t>(m.model.beams[beam].pixel_shift);
  ASSERT_EQ(shift, 16U);
  const std::string header = "P5 1024 32 255\n";
  std::vector<std::uint8_t> pgm(header.begin(), header.end());
  pgm.resize(header.size() + std::size_t{columns} * m.format.beams);
  pgm[header.size() + std::size_t{beam} * columns + 100] = 9;  // as seen, that is destaggered
  std::string error;
  const auto mask = ParseMaskImage({pgm.data(), pgm.size()}, m, &error);
  ASSERT_TRUE(mask) << error;
  for (std::uint32_t column = 0; column < columns; ++column)
    EXPECT_EQ((*mask)[std::size_t{beam} * columns + column], column == 100 - shift ? 9 : 0)
        << column;
}

}  // namespace
}  // namespace lidar::ouster
