// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/beam_locator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace lidar::codec::cloud {
namespace {

/// Returns a table of beams that are half a degree apart. The line of each beam starts up to
/// `most_um` above or below the origin.
BeamTable UnevenBeams(std::int32_t most_um) {
  std::mt19937 random(1);
  std::uniform_int_distribution<std::int32_t> height_um(-most_um, most_um);
  constexpr std::int32_t kHalfDegree = kTurn / 720;
  BeamTable table;
  table.turn = 1024 * BeamTable::kParts;
  for (std::int32_t i = 0; i < 64; ++i) {
    BeamTable::Beam beam;
    beam.elevation = (20 - i) * kHalfDegree;
    beam.height_um = height_um(random);
    table.beams.push_back(beam);
  }
  return table;
}

class LocatedBeams : public ::testing::TestWithParam<std::int32_t> {};

TEST_P(LocatedBeams, AreTheNearestOfAllAtAnyDistance) {
  const BeamTable table = UnevenBeams(GetParam());
  const BeamLocator locator(table);
  std::mt19937 random(2);
  std::uniform_real_distribution<float> slope(-0.5F, 0.3F);
  // At distances below `nearest_m`, the lines of beams that are not neighbours in the table cross.
  const float nearest_m = 1 + 1e-4F * static_cast<float>(GetParam());
  std::uniform_real_distribution<float> along(nearest_m, 10 * nearest_m);
  for (int i = 0; i < 50'000; ++i) {
    const float rho = along(random);
    const Sighting point({rho, 0, rho * slope(random)});
    double least = 1e9;
    for (std::uint32_t beam = 0; beam < table.rows(); ++beam)
      least = std::min(least, std::abs(locator.On(beam, point).above_m));
    EXPECT_EQ(std::abs(locator.Find(point).above_m), least) << rho;
  }
}
INSTANTIATE_TEST_SUITE_P(HeightsInMicrometres, LocatedBeams, ::testing::Values(0, 1'000, 30'000));

}  // namespace
}  // namespace lidar::codec::cloud
