// SPDX-License-Identifier: LGPL-2.1-or-later
// Scans that are computed with integers only, and the bytes to which they must always be coded.
#pragma once
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "src/codec/range_codec.h"

namespace lidar::test {

/// Returns a sensor whose beams have different column shifts.
inline SensorModel GoldenSensor(std::uint32_t beams, std::uint32_t columns) {
  SensorModel model;
  model.columns_per_scan = columns;
  for (std::uint32_t i = 0; i < beams; ++i)
    model.beams.push_back({0, 0, 5 - 3 * static_cast<int>(i % 4)});
  return model;
}

struct GoldenScan {
  std::uint32_t beams = 8;
  std::uint32_t columns = 64;
  std::uint32_t first_column = 0;
  std::uint32_t unit_mm = 1;
  unsigned lost_percent = 10;
};

/// Returns an image with walls, poles, noise, far returns and gaps.
inline codec::RangeImage GoldenImage(const GoldenScan& scan) {
  std::mt19937 random(scan.beams * 131 + scan.columns);
  codec::RangeImage image;
  image.beams = scan.beams;
  image.columns = scan.columns;
  image.first_column = scan.first_column;
  const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
  std::uint32_t gap = 0;
  for (std::uint32_t beam = 0; beam < scan.beams; ++beam) {
    for (std::uint32_t i = 0; i < scan.columns; ++i) {
      const std::uint32_t wall = 4'000 + 900 * (i / 24 % 7) + 15 * i + 40 * beam;
      std::uint32_t range = wall + below(12);
      if (i % 50 < 3) range = 2'000 + below(40);
      if (below(60) == 0) range = 90'000 + below(9'000);
      if (gap == 0 && below(100) < scan.lost_percent) gap = 1 + below(12);
      const bool lost = gap > 0;
      if (lost) --gap;
      image.ranges.push_back(lost ? 0 : range / scan.unit_mm * scan.unit_mm);
      image.intensity.push_back(
          static_cast<std::uint8_t>(lost ? 0 : 90 + 40 * (i / 24 % 4) + below(9)));
    }
  }
  return image;
}

inline std::vector<std::uint8_t> ReadGolden(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
  EXPECT_FALSE(bytes.empty()) << file;
  return bytes;
}

/// Expects that `bytes` equal the contents of the file. If UPDATE_GOLDEN is set in the environment,
/// writes the file first.
inline void ExpectGolden(const std::string& file, const std::vector<std::uint8_t>& bytes) {
  if (std::getenv("UPDATE_GOLDEN") != nullptr) {
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
  const std::vector<std::uint8_t> golden = ReadGolden(file);
  EXPECT_TRUE(bytes == golden) << "The format of " << file << " has changed: " << bytes.size()
                               << " bytes, " << golden.size() << " before";
}

struct GoldenBlock {
  const char* name;
  codec::RangeCoder coder;
  GoldenScan scan;
  std::uint32_t parts;  // the step of the grid
  unsigned intensity_bits;
  codec::FullScale full = codec::FullScale::kByte;
  std::uint32_t kept_beams = 0;
  std::uint32_t columns_per_scan = 1024;
  unsigned effort = 1;
  bool refined = false;
};
inline void PrintTo(const GoldenBlock& block, std::ostream* out) { *out << block.name; }

/// Expects that the block is coded to the bytes of its golden file, and that these bytes decode to
/// the rounded returns of the block.
inline void ExpectGoldenBlock(const GoldenBlock& c, const std::string& folder,
                              const codec::IntegerCoder* integers) {
  const SensorModel model = GoldenSensor(c.scan.beams, c.columns_per_scan);
  const codec::RangeImage image = GoldenImage(c.scan);
  const codec::RangeSettings settings{c.coder,
                                      RangeGrid::OfParts(c.scan.unit_mm, c.parts),
                                      codec::IntensityScale(c.full, c.intensity_bits),
                                      c.kept_beams,
                                      c.effort,
                                      c.refined};
  std::vector<std::uint8_t> bytes;
  codec::RangeEncoder encoder(model, integers);
  ASSERT_TRUE(encoder.Encode(image, settings, &bytes));
  ExpectGolden(folder + "/" + c.name + ".bin", bytes);

  codec::RangeDecoder decoder(model, integers);
  ByteReader reader(bytes.data(), bytes.size());
  codec::RangeImage back;
  codec::IntensityScale scale;
  ASSERT_TRUE(decoder.Decode(&reader, image.size(), &back, &scale));
  EXPECT_EQ(back.first_column, image.first_column);
  EXPECT_EQ(decoder.header().kept_beams, c.kept_beams);
  for (std::size_t i = 0; i < image.size(); ++i) {
    const std::uint32_t range = image.ranges[i];
    ASSERT_EQ(back.ranges[i], range == 0 ? 0 : settings.grid.RangeOf(settings.grid.BinOf(range)));
    if (c.intensity_bits == 0) continue;
    ASSERT_EQ(back.intensity[i], range == 0 ? 0 : scale.Coarsen(image.intensity[i]));
  }
}

}  // namespace lidar::test
