// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cloud/beam_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "src/cloud/point_math.h"
#include "src/cloud/range_projection.h"

namespace lidar {
namespace {

constexpr std::size_t kStep = 12;

/// Beams that are neither even nor all at one azimuth, as those of real sensors.
SensorModel Model(std::uint32_t columns, double origin_m) {
  SensorModel model;
  model.columns_per_scan = columns;
  model.beam_to_lidar_x_m = origin_m;
  for (int k = 0; k < 32; ++k)
    model.beams.push_back({k % 4 * 1.4 - 2.1 + 0.01 * k, 21.3 - 1.37 * k + 0.02 * (k % 3), 0});
  // Turned by half, as Ouster's sensor frame is, and raised.
  model.lidar_to_sensor = {-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0.036, 0, 0, 0, 1};
  return model;
}

/// Points at ranges [mm] of 0.6 to 60 m; a fourth of them is missing.
std::vector<float> Cloud(const SensorModel& model, std::uint32_t width) {
  std::mt19937 random(7);
  std::vector<std::uint32_t> ranges(std::size_t{width} * model.beams.size());
  std::uniform_int_distribution<std::uint32_t> range_mm(600, 60'000);
  for (auto& range : ranges) range = random() % 4 == 0 ? 0 : range_mm(random);
  std::vector<float> xyz(3 * ranges.size());
  RangeProjection(model).Project(ranges.data(), {0, width},
                                 reinterpret_cast<std::uint8_t*>(xyz.data()), kStep);
  return xyz;
}

const std::uint8_t* BytesOf(const std::vector<float>& xyz) {
  return reinterpret_cast<const std::uint8_t*>(xyz.data());
}

/// How far the points stand from those of their nearest whole range [m].
double WorstError(const SensorModel& model, std::uint32_t width, const std::vector<float>& xyz) {
  const RangeProjection projection(model);
  double worst = 0;
  for (std::uint32_t i = 0; i < xyz.size() / 3; ++i) {
    const auto p = PositionAt(BytesOf(xyz) + i * kStep);
    if (!IsReturn(p)) continue;
    const double range = projection.RangeOf(i / width, i % width, p.data());
    const auto q =
        projection.Point(i / width, i % width, static_cast<std::uint32_t>(std::lround(range)));
    worst = std::max(worst, SquaredDistance(p.data(), q.data()));
  }
  return std::sqrt(worst);
}

struct Case {
  const char* name;
  std::uint32_t columns;
  std::uint32_t width;
  double origin_m;
  bool mirrored;
};
class BeamFits : public ::testing::TestWithParam<Case> {};

TEST_P(BeamFits, PutEachPointWhereItWas) {
  const Case& c = GetParam();
  SensorModel model = Model(c.columns, c.origin_m);
  if (c.mirrored) model.lidar_to_sensor[5] = 1;
  const auto xyz = Cloud(model, c.width);
  BeamFit fit(c.width, 32);
  fit.Add(BytesOf(xyz), kStep);
  const auto found = fit.Fit();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->columns_per_scan, c.columns);
  EXPECT_NEAR(found->beam_to_lidar_x_m, c.origin_m, 1e-4);
  EXPECT_LT(WorstError(*found, c.width, xyz), 0.6e-3);  // half a millimetre of rounding, and floats
}

INSTANTIATE_TEST_SUITE_P(Of, BeamFits,
                         ::testing::Values(Case{"whole_turn", 1024, 1024, 0.0277, false},
                                           Case{"window", 1024, 300, 0.0158, false},
                                           Case{"no_origin", 512, 512, 0, false},
                                           Case{"counter_clockwise", 512, 512, 0.0158, true}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(BeamFit, PutsABeamThatSawNothingBetweenItsNeighbours) {
  const SensorModel model = Model(512, 0.0158);
  auto xyz = Cloud(model, 512);
  std::fill_n(xyz.begin() + 3 * 512 * 5, 3 * 512, 0.F);
  BeamFit fit(512, 32);
  fit.Add(BytesOf(xyz), kStep);
  const auto found = fit.Fit();
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->beams[5].altitude_deg, model.beams[5].altitude_deg, 0.1);
}

TEST(BeamFit, GivesNothingWhereThereIsTooLittle) {
  BeamFit empty(512, 32);
  EXPECT_FALSE(empty.Fit());
  const std::vector<float> missing(3 * 512 * 32, 0.F);
  empty.Add(BytesOf(missing), kStep);
  EXPECT_FALSE(empty.Fit());
  BeamFit narrow(8, 32);
  narrow.Add(BytesOf(missing), kStep);
  EXPECT_FALSE(narrow.Fit());
}

TEST(BeamFit, FitsNoCloudWhosePointsHaveNoOrder) {
  std::mt19937 random(3);
  std::vector<float> xyz(3 * 512 * 32);
  for (float& v : xyz) v = static_cast<float>(random() % 20'000) * 1e-3F - 10;
  BeamFit fit(512, 32);
  fit.Add(BytesOf(xyz), kStep);
  const auto found = fit.Fit();
  if (found) {
    EXPECT_GT(WorstError(*found, 512, xyz), 1);
  }
}

}  // namespace
}  // namespace lidar
