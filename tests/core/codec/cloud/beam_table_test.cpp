// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/beam_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>
#include <tuple>
#include <vector>

#include "src/base/byte_writer.h"
#include "src/codec/cloud/beam_columns.h"
#include "src/codec/cloud/beam_part.h"
#include "src/codec/cloud/path_fit.h"
#include "src/codec/mixing/binary_coder.h"
#include "src/codec/varint.h"
#include "tests/core/codec/cloud/beam_clouds.h"

namespace lidar::codec::cloud {
namespace {

/// Writes the table, and returns the table that a decoder reads.
std::optional<BeamTable> ThroughBytes(const BeamTable& table) {
  std::vector<std::uint8_t> bytes;
  ByteWriter writer(&bytes);
  table.Write(&writer);
  mixing::BinaryEncoder encoder(&bytes);
  BeamTable coded = table;
  const bool has_beams = !table.has_path();
  if (has_beams) CodeBeams(&coded, &encoder);
  encoder.Finish();
  ByteReader reader(bytes.data(), bytes.size());
  auto read = BeamTable::Read(&reader);
  mixing::BinaryDecoder decoder(reader.Rest());
  if (read && has_beams && !(CodeBeams(&*read, &decoder) && decoder.AtEnd())) return std::nullopt;
  return read;
}

/// Returns 64 beams whose pattern repeats every four beams, as in a sensor of modules. Each beam
/// deviates a bit from the pattern.
BeamTable PatternedTable() {
  std::mt19937 random(8);
  BeamTable table;
  table.turn = 1'024 * BeamTable::kParts;
  std::int32_t elevation = kTurn / 16;
  for (int i = 0; i < 64; ++i) {
    BeamTable::Beam beam;
    const auto off = [&] { return static_cast<std::int32_t>(random() % 16); };
    beam.elevation = elevation -= 8'000 + off();
    beam.offset = (3'000 - 40'000 * (i % 4) + off()) & (kTurn - 1);
    beam.height_um = BeamTable::kLengthUnitUm * (600 + 5 * i + off() / 8);
    beam.side_um = BeamTable::kLengthUnitUm * (i % 4) * 16;
    beam.reach_um = -500;
    table.beams.push_back(beam);
  }
  return table;
}

TEST(BeamTable, TakesFewBytesForPatterns) {
  std::vector<std::uint8_t> bytes;
  mixing::BinaryEncoder encoder(&bytes);
  BeamTable table = PatternedTable();
  EXPECT_TRUE(CodeBeams(&table, &encoder));
  encoder.Finish();
  EXPECT_LE(bytes.size(), 160U);
  const auto again = ThroughBytes(table);
  ASSERT_TRUE(again);
  const BeamTable before = PatternedTable();
  for (std::size_t i = 0; i < 64; ++i) {
    const BeamTable::Beam& a = again->beams[i];
    const BeamTable::Beam& b = before.beams[i];
    EXPECT_EQ(std::tie(a.elevation, a.offset, a.height_um, a.side_um, a.reach_um),
              std::tie(b.elevation, b.offset, b.height_um, b.side_um, b.reach_um))
        << i;
  }
}

// The first encoders did not use CodeBeams(). They wrote the beams as numbers after the flags.
TEST(BeamTable, ReadsTheBeamsOfTheFirstEncoders) {
  std::vector<std::uint8_t> bytes;
  ByteWriter writer(&bytes);
  const auto write = [&](std::uint32_t number) { WriteVarint(number, &writer); };
  const auto write_signed = [&](std::int32_t number) {
    write(static_cast<std::uint32_t>(std::abs(number)) << 1 | (number < 0 ? 1U : 0U));
  };
  write(1'024 * BeamTable::kParts);
  write(2);
  writer.U8(1 | 4);  // The beams have heights, sides and reaches.
  for (const auto& [below, offset, higher, aside, reach] :
       {std::tuple(8'000U, 300U, 600, -50, -500), std::tuple(9'000U, 40'000U, 5, 100, 250)}) {
    write(below);
    write(offset);
    for (const std::int32_t number : {higher, aside, reach}) write_signed(number);
  }
  ByteReader reader(bytes.data(), bytes.size());
  const auto table = BeamTable::Read(&reader);
  ASSERT_TRUE(table && table->rows() == 2);
  EXPECT_TRUE(!table->beams_follow && reader.ok() && reader.remaining() == 0);
  const auto numbers = [](const BeamTable::Beam& b) {
    return std::tuple(b.elevation, b.offset, b.height_um, b.side_um, b.reach_um);
  };
  EXPECT_EQ(numbers(table->beams[0]), std::tuple(kTurn / 4 - 8'000, 300, 600, -50, -500));
  EXPECT_EQ(numbers(table->beams[1]), std::tuple(kTurn / 4 - 17'000, 40'000, 605, 50, 250));
}

TEST(BeamTable, IsRefusedWithBeamsThatNoEncoderWrites) {
  const auto is_read = [](const auto& change) {
    BeamTable table = PatternedTable();
    table.grains = 36'000;
    table.places.assign(table.columns(), 0);
    table.period = 2;
    change(&table, &table.beams[40]);
    std::vector<std::uint8_t> bytes;
    ByteWriter writer(&bytes);
    table.Write(&writer);
    mixing::BinaryEncoder encoder(&bytes);
    CodeBeams(&table, &encoder);
    encoder.Finish();
    ByteReader reader(bytes.data(), bytes.size());
    auto read = BeamTable::Read(&reader);
    mixing::BinaryDecoder decoder(reader.Rest());
    return read && CodeBeams(&*read, &decoder);
  };
  using Beam = BeamTable::Beam;
  EXPECT_TRUE(is_read([](BeamTable*, Beam*) {}));
  EXPECT_FALSE(is_read([](BeamTable*, Beam* beam) { beam->elevation = kTurn / 8; }));
  EXPECT_FALSE(is_read([](BeamTable*, Beam* beam) { beam->elevation = -kTurn / 4 - 1; }));
  EXPECT_FALSE(is_read([](BeamTable*, Beam* beam) { beam->delay = 1'024; }));
  EXPECT_FALSE(is_read([](BeamTable*, Beam* beam) { beam->swings[1] = kTurn + 16; }));
  for (const auto length : {&Beam::height_um, &Beam::side_um, &Beam::reach_um})
    EXPECT_FALSE(is_read([&](BeamTable*, Beam* beam) { beam->*length = 1'000'050; }));
}

TEST(BeamTable, FindsTheBeamsAndColumnsOfASensor) {
  std::vector<Sighting> sightings;
  for (const auto& p : SpinningScan(0)) sightings.emplace_back(Point{p[0], p[1], p[2]});
  const auto table = FindBeams(sightings);
  ASSERT_TRUE(table);
  EXPECT_EQ(table->rows(), 16U);
  EXPECT_EQ(table->turn, 450U * BeamTable::kParts);
  EXPECT_NEAR(table->beams[0].elevation * kRadians * 180 / M_PI, 15, 1e-3);
  const auto again = ThroughBytes(*table);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->turn, table->turn);
  for (std::uint32_t i = 0; i < 16; ++i) {
    // Beams are rounded to 12 millionths of a radian, which is exact enough and takes few bits.
    EXPECT_EQ(table->beams[i].elevation % 8, 0);
    EXPECT_EQ(table->beams[i].offset % 8, 0);
    EXPECT_EQ(again->beams[i].elevation, table->beams[i].elevation);
    EXPECT_EQ(again->beams[i].offset, table->beams[i].offset);
  }
}

TEST(BeamTable, FindsBeamsThatBend) {
  std::vector<Sighting> sightings;
  for (const auto& p : BendingScan(0)) sightings.emplace_back(Point{p[0], p[1], p[2]});
  const auto table = FindBeams(sightings);
  ASSERT_TRUE(table);
  EXPECT_TRUE(table->bends);
  EXPECT_EQ(table->rows(), 12U);
  const auto again = ThroughBytes(*table);
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->bends);
  for (std::uint32_t i = 0; i < 12; ++i) {
    EXPECT_EQ(again->beams[i].elevation, table->beams[i].elevation);
    EXPECT_EQ(again->beams[i].offset, table->beams[i].offset);
  }
}

/// The directions and the pulses of a cloud, which FindPath() needs.
struct PathSightings {
  explicit PathSightings(const PathCloud& cloud) {
    for (const PathPoint& p : cloud) {
      points.emplace_back(Point{p.x, p.y, p.z});
      pulses.push_back({p.line, p.timestamp});
    }
  }
  std::vector<Sighting> points;
  std::vector<Pulse> pulses;
};

TEST(BeamTable, FindsThePathOfBeamsAndWritesIt) {
  const PathSightings seen(PathScan(0));
  std::vector<PlacedPoint> placed;
  const auto table = FindPath(seen.points, seen.pulses, &placed);
  ASSERT_TRUE(table);
  EXPECT_EQ(table->rows(), 4U);
  EXPECT_NEAR(table->columns(), 1'000, 8);
  for (std::size_t i = 0; i < placed.size(); ++i) {
    EXPECT_EQ(placed[i].beam, seen.pulses[i].line);
    EXPECT_NEAR(placed[i].above_m, 0, 0.002);
    EXPECT_NEAR(placed[i].residual * kRadians * seen.points[i].rho_m, 0, 0.02);
  }
  const auto again = ThroughBytes(*table);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->rate, table->rate);
  EXPECT_EQ(again->rows(), 4U);
}

/// Most columns follow after a time that is 2 % too short, and some after a time that is too long.
/// No point is seen for 400 columns.
TEST(BeamTable, CountsColumnsOfAPathByTheirMeanTimeOverAGap) {
  constexpr double kBegin = 1.7e18;
  constexpr double kFiringNs = 25'000;
  constexpr double kEarlyNs[] = {0, -2'000, -4'000, -6'000, -3'000};
  PathCloud cloud;
  std::vector<std::uint32_t> columns;
  for (PathPoint p : PathScan(0)) {
    const auto firing = static_cast<std::uint32_t>((p.timestamp - kBegin) / kFiringNs + 0.5);
    const std::uint32_t column = firing / 4;
    if (column >= 300 && column < 700) continue;
    p.timestamp = kBegin + kFiringNs * firing + kEarlyNs[column % 5];
    cloud.push_back(p);
    columns.push_back(column);
  }
  const PathSightings seen(cloud);
  std::vector<PlacedPoint> placed;
  const auto table = FindPath(seen.points, seen.pulses, &placed);
  ASSERT_TRUE(table);
  ASSERT_EQ(placed.size(), columns.size());
  for (std::size_t i = 0; i < placed.size(); ++i)
    ASSERT_EQ(placed[i].column, columns[i] - columns.front()) << i;
}

TEST(BeamTable, RefusesAPathThatDoesNotTurnOrHasTooManyBeams) {
  // The bytes are the number of columns (three bytes), the number of beams, the flags and the rate.
  const auto read = [](std::uint8_t beams, std::uint8_t rate) {
    const std::vector<std::uint8_t> bytes = {0x80, 0x80, 1, beams, 64, rate};
    ByteReader reader(bytes.data(), bytes.size());
    return BeamTable::Read(&reader).has_value();
  };
  EXPECT_TRUE(read(16, 2));
  EXPECT_FALSE(read(16, 0));
  EXPECT_FALSE(read(17, 2));
}

/// The upper and the lower beams start at different heights, as in an HDL-64. On the floor, each
/// beam sees a ring. Lines from any height pass through a ring, so the floor does not show at which
/// height a beam starts.
TEST(BeamTable, FindsTheBeamsOverAFlatFloor) {
  std::vector<Sighting> sightings;
  std::mt19937 random(20);
  for (int firing = 0; firing < 600; ++firing)
    for (int beam = 0; beam < 64; ++beam) {
      const bool upper = beam < 32;
      const double azimuth = 0.6 * firing * M_PI / 180;
      const double tangent = upper ? 0.034 - 0.0061 * beam : 0.155 - 0.0098 * beam;
      const double height = upper ? 0.2 : 0.12;
      const double wall =
          std::min(12 / std::abs(std::cos(azimuth)), 13 / std::abs(std::sin(azimuth)));
      double rho = wall + 0.3 * (firing / 40 % 3);
      if (tangent < 0) rho = std::min(rho, (1.73 + height) / -tangent);
      rho += 1e-3 * (static_cast<double>(random() % 21) - 10);
      sightings.emplace_back(Point{static_cast<float>(rho * std::cos(azimuth)),
                                   static_cast<float>(rho * std::sin(azimuth)),
                                   static_cast<float>(height + rho * tangent)});
    }
  const auto table = FindBeams(sightings);
  ASSERT_TRUE(table);
  EXPECT_GE(table->rows(), 64U);
  EXPECT_LE(table->rows(), 68U);
}

TEST(BeamTable, FindsNoneInACloudWithoutBeams) {
  std::mt19937 random(4);
  std::vector<Sighting> sightings;
  for (int i = 0; i < 20'000; ++i)
    sightings.emplace_back(Point{static_cast<float>(random() % 10'000) * 0.01F - 50,
                                 static_cast<float>(random() % 10'000) * 0.01F - 50,
                                 static_cast<float>(random() % 1'000) * 0.01F});
  EXPECT_FALSE(FindBeams(sightings));
}

}  // namespace
}  // namespace lidar::codec::cloud
