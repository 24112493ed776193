// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/synth/scanner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lidar::synth {
namespace {

ScannerConfig Config(SceneKind scene = SceneKind::kStreet) {
  ScannerConfig config;
  config.sensor = *MakeSensor("os1-32", 512);
  config.scene = scene;
  config.speed_mps = 12;
  config.seed = 5;
  return config;
}

std::vector<std::uint32_t> Ranges(const ScannerConfig& config, std::uint64_t scan) {
  Scanner scanner(config);
  Returns returns;
  scanner.Cast(scan, {0, config.sensor.model.columns_per_scan}, &returns);
  return returns.range_mm;
}

double ShareOfReturns(const std::vector<std::uint32_t>& ranges) {
  const auto missing = std::count(ranges.begin(), ranges.end(), 0U);
  return 1.0 - static_cast<double>(missing) / static_cast<double>(ranges.size());
}

class EveryScene : public ::testing::TestWithParam<SceneKind> {};
INSTANTIATE_TEST_SUITE_P(All, EveryScene,
                         ::testing::Values(SceneKind::kStreet, SceneKind::kTunnel,
                                           SceneKind::kField, SceneKind::kTown));

TEST_P(EveryScene, IsTheSameHoweverTheScanIsCut) {
  const ScannerConfig config = Config(GetParam());
  const auto whole = Ranges(config, 7);
  Scanner scanner(config);
  Returns slice;
  for (std::uint32_t first = 0; first < 512; first += 32) {
    scanner.Cast(7, {first, 32}, &slice);
    for (std::uint32_t beam = 0; beam < 32; ++beam)
      for (std::uint32_t i = 0; i < 32; ++i)
        ASSERT_EQ(slice.range_mm[beam * 32 + i], whole[beam * 512 + first + i]);
  }
}

TEST_P(EveryScene, FollowsFromItsSeed) {
  ScannerConfig config = Config(GetParam());
  const auto first = Ranges(config, 3);
  EXPECT_EQ(first, Ranges(config, 3));
  config.seed = 6;
  EXPECT_NE(first, Ranges(config, 3));
}

TEST_P(EveryScene, StaysWithinTheReachOfTheSensor) {
  const ScannerConfig config = Config(GetParam());
  for (const std::uint32_t range : Ranges(config, 40))
    EXPECT_TRUE(range == 0 || (range >= 300 && range <= 170'000)) << range;
}

TEST_P(EveryScene, SeesNothingNearerThanTheSensorCan) {
  ScannerConfig config = Config(GetParam());
  config.second_returns = true;
  const auto returns = [&config] {
    Scanner scanner(config);
    Returns r;
    scanner.Cast(40, {0, 512}, &r);
    return r;
  };
  const Returns all = returns();
  config.sensor.min_range_m = 8;
  const Returns far = returns();
  std::size_t gone = 0;
  for (std::size_t i = 0; i < all.range_mm.size(); ++i) {
    gone += all.range_mm[i] != 0 && all.range_mm[i] < 8'000;
    EXPECT_TRUE(far.range_mm[i] == 0 || far.range_mm[i] >= 8'000) << far.range_mm[i];
    EXPECT_TRUE(far.range2_mm[i] == 0 || far.range2_mm[i] >= 8'000) << far.range2_mm[i];
  }
  EXPECT_GT(gone, 0U);
}

TEST_P(EveryScene, GivesTwoEchoesWhereABeamMeetsTwoThings) {
  ScannerConfig config = Config(GetParam());
  config.second_returns = true;
  Scanner scanner(config);
  Returns r;
  scanner.Cast(2, {0, 512}, &r);
  std::size_t both = 0;
  for (std::size_t i = 0; i < r.range_mm.size(); ++i) {
    if (r.range2_mm[i] == 0) continue;
    ++both;
    ASSERT_GE(r.signal[i], r.signal2[i]);
    ASSERT_GE(std::abs(static_cast<double>(r.range_mm[i]) - r.range2_mm[i]), 400);
  }
  const double share = static_cast<double>(both) / static_cast<double>(r.range_mm.size());
  EXPECT_GT(share, 0.001);
  EXPECT_LT(share, 0.2);
  // The option for second returns does not change how many pixels have a first return.
  EXPECT_NEAR(ShareOfReturns(r.range_mm), ShareOfReturns(Ranges(Config(GetParam()), 2)), 0.02);
}

// If each column has a pose of its own, the points of the ground are within a millimetre of the
// ground, because ranges are rounded to a millimetre. With one pose per scan, points would be wrong
// by 1.2 m along the road, and by centimetres in height because of the pitch.
TEST(Scanner, EveryColumnIsSampledFromItsOwnPose) {
  ScannerConfig config = Config();
  config.noise_m = 0;
  Scanner scanner(config);
  const RangeProjection projection(config.sensor.model);
  Returns returns;
  scanner.Cast(20, {0, 512}, &returns);
  int low = 0;
  int on_the_road = 0;
  for (std::uint32_t column = 0; column < 512; ++column) {
    const Pose pose = scanner.trajectory().At(scanner.ColumnTime(20, column));
    for (std::uint32_t beam = 0; beam < 32; ++beam) {
      const std::uint32_t range = returns.range_mm[beam * 512 + column];
      if (range == 0) continue;
      const auto p = projection.Point(beam, column, range);
      const Vec3 world = pose.ToRotation() * Vec3{p[0], p[1], p[2]};
      const double z = static_cast<double>(world.z) + pose.z;
      EXPECT_GT(z, -0.002);
      low += z < 0.04 ? 1 : 0;  // points of the road, and the lowest points of kerbs and wheels
      on_the_road += z < 0.002 ? 1 : 0;
    }
  }
  EXPECT_GT(on_the_road, 2000);
  EXPECT_GT(on_the_road, low * 97 / 100);
}

TEST(Scanner, RangesSpreadByTheNoiseThatWasAskedFor) {
  ScannerConfig config = Config(SceneKind::kTunnel);
  config.noise_m = 0;
  const auto exact = Ranges(config, 1);
  config.noise_m = 0.02;
  const auto noisy = Ranges(config, 1);
  double sum = 0;
  double squares = 0;
  int n = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    if (exact[i] == 0 || noisy[i] == 0 || exact[i] > 12'000) continue;  // only strong echoes
    const double d = static_cast<double>(noisy[i]) - static_cast<double>(exact[i]);
    sum += d;
    squares += d * d;
    ++n;
  }
  ASSERT_GT(n, 5000);
  EXPECT_NEAR(sum / n, 0, 1);
  EXPECT_NEAR(std::sqrt(squares / n), 20, 1);
}

TEST(Scanner, TheSkyGivesNoReturnAndTheTunnelNearlyAlways) {
  EXPECT_NEAR(ShareOfReturns(Ranges(Config(SceneKind::kStreet), 2)), 0.83, 0.08);
  EXPECT_NEAR(ShareOfReturns(Ranges(Config(SceneKind::kField), 2)), 0.5, 0.15);
  EXPECT_GT(ShareOfReturns(Ranges(Config(SceneKind::kTunnel), 2)), 0.95);
}

TEST(Scanner, ReflectivityTellsPaintFromAsphaltAndSignsFromBoth) {
  Scanner scanner(Config());
  Returns returns;
  std::array<int, 256> histogram{};
  for (std::uint64_t scan = 0; scan < 10; ++scan) {
    scanner.Cast(scan * 5, {0, 512}, &returns);
    for (std::size_t i = 0; i < returns.range_mm.size(); ++i)
      if (returns.range_mm[i] != 0) ++histogram[returns.reflectivity[i]];
  }
  const auto share = [&](int from, int to) {
    return std::accumulate(histogram.begin() + from, histogram.begin() + to, 0);
  };
  EXPECT_GT(share(10, 17), 10'000);  // asphalt
  EXPECT_GT(share(40, 100), 5'000);  // walls, lines
  EXPECT_GT(share(150, 256), 20);    // retroreflectors
}

TEST(Scanner, ScanNumbersOfADayDoNotBlurThePicture) {
  ScannerConfig config = Config();
  config.noise_m = 0;
  config.speed_mps = 30;
  Scanner scanner(config);
  const RangeProjection projection(config.sensor.model);
  Returns returns;
  const std::uint64_t scan = 24 * 36'000;  // After a day, the car has driven 2,592 km.
  scanner.Cast(scan, {128, 4}, &returns);
  const Pose pose = scanner.trajectory().At(scanner.ColumnTime(scan, 128));
  double lowest = 0;
  for (std::uint32_t beam = 16; beam < 32; ++beam) {
    const auto p = projection.Point(beam, 128, returns.range_mm[beam * 4]);
    if (returns.range_mm[beam * 4] == 0) continue;
    const Vec3 world = pose.ToRotation() * Vec3{p[0], p[1], p[2]};
    lowest = std::min(lowest, static_cast<double>(world.z) + pose.z);
  }
  EXPECT_GT(lowest, -0.002);
}

}  // namespace
}  // namespace lidar::synth
