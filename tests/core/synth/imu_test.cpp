// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/synth/imu.h"

#include <gtest/gtest.h>

#include <cmath>

#include "src/synth/scanner.h"

namespace lidar::synth {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

Scanner DriveThrough(SceneKind scene, double roughness) {
  ScannerConfig config;
  config.sensor = *MakeSensor("os0-32", 512);
  config.scene = scene;
  config.speed_mps = 12;
  config.roughness = roughness;
  return Scanner(config);
}

using Quaternion = std::array<double, 4>;
Quaternion Times(const Quaternion& a, const Quaternion& b) {
  return {a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
          a[3] * b[1] + a[1] * b[3] + a[2] * b[0] - a[0] * b[2],
          a[3] * b[2] + a[2] * b[3] + a[0] * b[1] - a[1] * b[0],
          a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
}

TEST(TrueMotion, ItsTurnsAddUpToThoseOfTheDrive) {
  for (const auto scene : {SceneKind::kTown, SceneKind::kField}) {
    const Scanner drive = DriveThrough(scene, 5);
    const auto orientation = [&](Duration t) { return drive.trajectory().At(t).ToQuaternion(); };
    Quaternion turned = orientation({});
    constexpr Duration kStep = milliseconds(10);
    for (Duration t = kStep / 2; t < seconds(20); t += kStep) {
      const auto rate = TrueMotion(drive.trajectory(), t).angular_velocity;
      Quaternion step = {0, 0, 0, 1};
      for (std::size_t i = 0; i < 3; ++i) step[i] = rate[i] * Seconds(kStep) / 2;
      turned = Times(turned, step);
    }
    const Quaternion end = orientation(seconds(20));
    double cosine = 0;
    double square = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      cosine += turned[i] * end[i];
      square += turned[i] * turned[i];
    }
    EXPECT_LT(2 * std::acos(std::min(1.0, std::abs(cosine) / std::sqrt(square))), 2e-3);
  }
}

/// A route that turns to the left by one radian per second, on the spot.
class TurningRoute : public Route {
 public:
  Place At(double time_s) const override {
    Place place;
    place.yaw = std::remainder(time_s, 2 * M_PI);
    return place;
  }
};

TEST(TrueMotion, TurnsNoFasterWhereTheHeadingPasses180Degrees) {
  TrajectorySettings settings;
  settings.sway_m = settings.bounce = 0;
  settings.route = std::make_shared<TurningRoute>();
  const Trajectory trajectory(settings);
  for (Duration t{}; t < seconds(7); t += milliseconds(10))
    ASSERT_NEAR(TrueMotion(trajectory, t).angular_velocity[2], 1, 1e-4) << Seconds(t);
}

TEST(TrueMotion, ItsAccelerationsAddUpToTheChangeOfSpeed) {
  const Scanner drive = DriveThrough(SceneKind::kTown, 1);
  const Trajectory& trajectory = drive.trajectory();
  std::array<double, 3> gained{};
  constexpr Duration kStep = milliseconds(10);
  for (Duration t = kStep / 2; t < seconds(20); t += kStep) {
    const auto felt = TrueMotion(trajectory, t).acceleration;
    const Rotation r = trajectory.At(t).ToRotation();
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        gained[i] += double{r.m[3 * i + k]} * felt[k] * Seconds(kStep);
  }
  gained[2] -= 9.80665 * 20;
  const auto velocity = [&](Duration t) {
    const Pose a = trajectory.At(t - milliseconds(5));
    const Pose b = trajectory.At(t + milliseconds(5));
    return std::array<double, 3>{(b.x - a.x) * 100, (b.y - a.y) * 100, (b.z - a.z) * 100};
  };
  const auto before = velocity({});
  const auto after = velocity(seconds(20));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(gained[i], after[i] - before[i], 0.02) << i;
}

/// Returns the samples of a sensor that is at rest for 100 s.
std::vector<ImuSample> AtRest(const ImuSpec& spec, std::uint64_t seed) {
  return Imu(Trajectory(TrajectorySettings{}), spec, seed).Until(seconds(100));
}

TEST(Imu, HasTheNoiseThatItsDataSheetStates) {
  ImuSpec spec = kMemsImu;
  const auto samples = AtRest(spec, 1);
  ASSERT_EQ(samples.size(), 10'000U);
  // The difference between consecutive samples does not contain the bias.
  const auto noise_of = [&](auto value) {
    double squares = 0;
    for (std::size_t i = 1; i < samples.size(); ++i)
      squares += std::pow(value(samples[i]) - value(samples[i - 1]), 2);
    return std::sqrt(squares / 2 / static_cast<double>(samples.size() - 1));
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double root_band = std::sqrt(50.0);
    EXPECT_NEAR(noise_of([=](const ImuSample& s) { return s.angular_velocity[axis]; }),
                spec.gyroscope.noise_density * root_band, 1e-4);
    EXPECT_NEAR(noise_of([=](const ImuSample& s) { return s.acceleration[axis]; }),
                spec.accelerometer.noise_density * root_band, 1e-3);
  }
}

TEST(Imu, HasOffsetsOfItsOwn) {
  ImuSpec spec = kMemsImu;
  spec.gyroscope.noise_density = spec.accelerometer.noise_density = 0;
  double squares = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const auto samples = AtRest(spec, seed);
    const ImuSample& first = samples.front();
    EXPECT_NEAR(first.acceleration[2], 9.80665, 5 * spec.accelerometer.offset);
    squares += std::pow(first.angular_velocity[0], 2);
    // Within 100 s the bias changes by a few degrees per hour only.
    EXPECT_NEAR(samples.back().angular_velocity[0], first.angular_velocity[0],
                10 * spec.gyroscope.bias_instability);
    EXPECT_NE(samples.back().angular_velocity[0], first.angular_velocity[0]);
  }
  EXPECT_NEAR(std::sqrt(squares / 100), spec.gyroscope.offset, 0.2 * spec.gyroscope.offset);
}

/// After its correlation time, a Gauss-Markov process has changed by sqrt(2 (1 - 1/e)) standard
/// deviations (root mean square).
TEST(Imu, ItsBiasesWanderAsTheirInstabilityStates) {
  ImuSpec spec = kMemsImu;
  spec.gyroscope.noise_density = spec.accelerometer.noise_density = 0;
  double gyroscope = 0;
  double accelerometer = 0;
  constexpr int kUnits = 50;
  for (std::uint64_t seed = 0; seed < kUnits; ++seed) {
    const auto samples = AtRest(spec, seed);
    const ImuSample& first = samples.front();
    const ImuSample& last = samples.back();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      gyroscope += std::pow(last.angular_velocity[axis] - first.angular_velocity[axis], 2);
      accelerometer += std::pow(last.acceleration[axis] - first.acceleration[axis], 2);
    }
  }
  const double wander = std::sqrt(2 * (1 - std::exp(-1))) / 0.618;
  for (const auto& [squares, errors] :
       {std::pair(gyroscope, spec.gyroscope), std::pair(accelerometer, spec.accelerometer)}) {
    const double expected = wander * errors.bias_instability;
    EXPECT_NEAR(std::sqrt(squares / (3 * kUnits)), expected, 0.15 * expected);
  }
}

TEST(Imu, MeasuresEachPeriodOnce) {
  Imu imu(Trajectory(TrajectorySettings{}), kMemsImu, 1);
  EXPECT_EQ(imu.Until(milliseconds(25)).size(), 3U);
  EXPECT_EQ(imu.Until(milliseconds(30)).size(), 0U);
  imu.SkipTo(milliseconds(95));
  const auto after = imu.Until(milliseconds(120));
  ASSERT_EQ(after.size(), 2U);
  EXPECT_EQ(after[0].time, Time{} + milliseconds(100));
  imu.SkipTo(milliseconds(50));
  EXPECT_EQ(imu.Until(milliseconds(121)).front().time, Time{} + milliseconds(120));
}

}  // namespace
}  // namespace lidar::synth
