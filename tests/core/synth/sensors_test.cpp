// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/synth/sensors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "src/cloud/range_projection.h"

namespace lidar::synth {
namespace {

struct Expected {
  const char* name;
  std::size_t beams;
  double view_deg;
};
class Sensors : public ::testing::TestWithParam<Expected> {};

TEST_P(Sensors, LookDownFromTopToBottomOverTheFieldOfViewOfTheDataSheet) {
  const auto sensor = MakeSensor(GetParam().name, 1024);
  ASSERT_TRUE(sensor);
  const auto& beams = sensor->model.beams;
  ASSERT_EQ(beams.size(), GetParam().beams);
  for (std::size_t i = 1; i < beams.size(); ++i)
    EXPECT_LT(beams[i].altitude_deg, beams[i - 1].altitude_deg);
  EXPECT_NEAR(beams.front().altitude_deg - beams.back().altitude_deg, GetParam().view_deg, 0.2);
  const auto bytes = sensor->model.Serialise();
  EXPECT_TRUE(SensorModel::Parse({bytes.data(), bytes.size()}));
}

TEST_P(Sensors, StandInOneLineOnceDestaggered) {
  for (const std::uint32_t columns : {512U, 1024U, 2048U, 4096U}) {
    const auto sensor = MakeSensor(GetParam().name, columns);
    for (const Beam& b : sensor->model.beams)
      EXPECT_NEAR(b.azimuth_deg * columns / 360, b.pixel_shift, 0.5);
  }
}

TEST_P(Sensors, BeginTheirTurnBehindAndGoClockwise) {
  const auto sensor = MakeSensor(GetParam().name, 1024);
  const RangeProjection projection(sensor->model);
  for (std::uint32_t beam = 0; beam < GetParam().beams; ++beam) {
    const double offset = sensor->model.beams[beam].azimuth_deg;
    const auto azimuth_of = [&](std::uint32_t column) {
      const auto direction = projection.Direction(beam, column);
      return std::atan2(double{direction[1]}, double{direction[0]}) * 180 / std::acos(-1.0);
    };
    EXPECT_NEAR(std::remainder(azimuth_of(0) + offset - 180, 360), 0, 0.1) << beam;
    EXPECT_NEAR(std::remainder(azimuth_of(256) + offset - 90, 360), 0, 0.1) << beam;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, Sensors,
    ::testing::Values(Expected{"os0-32", 32, 91.2}, Expected{"os0-64", 64, 91.2},
                      Expected{"os0-128", 128, 91.2}, Expected{"os1-32", 32, 42.8},
                      Expected{"os1-64", 64, 42.8}, Expected{"os1-128", 128, 42.8},
                      Expected{"os2-32", 32, 21.2}, Expected{"os2-64", 64, 21.2},
                      Expected{"os2-128", 128, 21.2}));

TEST(Firings, FollowTheManuals) {
  const auto first = [](const char* name) {
    const Firing& firing = *FindFiring(name);
    std::vector<double> elevations;
    for (std::uint32_t laser = 0; laser < 4; ++laser)
      elevations.push_back(firing.ElevationOf(laser));
    return elevations;
  };
  EXPECT_EQ(first("vlp-16"), (std::vector<double>{-15, 1, -13, 3}));
  EXPECT_EQ(first("xt32"), (std::vector<double>{15, 14, 13, 12}));
  EXPECT_EQ(FindFiring("vlp-16")->RingOf(1), 8U);
  EXPECT_NEAR(FindFiring("at128")->ElevationOf(127), -12.9, 1e-9);
  EXPECT_EQ(FindFiring("vlp-32"), nullptr);
}

TEST(MakeSensor, KnowsNoOthers) {
  for (const char* name : {"", "os1", "os1-", "os1-16", "os3-64", "os1_64", "os1-64x", "OS1-64"})
    EXPECT_FALSE(MakeSensor(name, 1024)) << name;
  EXPECT_FALSE(MakeSensor("os1-64", 1000));
}

}  // namespace
}  // namespace lidar::synth
