// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/synth/trajectory.h"

#include <gtest/gtest.h>

namespace lidar::synth {
namespace {

Trajectory At12() {
  TrajectorySettings settings;
  settings.speed_mps = 12;
  settings.lane_y_m = -1.75;
  return Trajectory(settings);
}

TEST(Trajectory, HeadsWhereItGoes) {
  const Trajectory trajectory = At12();
  const Duration step = std::chrono::milliseconds(1);
  for (int ms = 0; ms < 20'000; ms += 777) {
    const Pose a = trajectory.At(std::chrono::milliseconds(ms) - step);
    const Pose b = trajectory.At(std::chrono::milliseconds(ms) + step);
    const double heading = std::atan2(b.y - a.y, b.x - a.x);
    EXPECT_NEAR(trajectory.At(std::chrono::milliseconds(ms)).yaw, heading, 1e-6);
    EXPECT_NEAR((b.x - a.x) / Seconds(2 * step), 12, 1e-6);
  }
}

TEST(Trajectory, StandsStillAtSpeedZero) {
  const Trajectory trajectory{TrajectorySettings{}};
  const Pose a = trajectory.At(Duration::zero());
  const Pose b = trajectory.At(std::chrono::hours(1));
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.z, b.z);
  EXPECT_EQ(a.yaw, b.yaw);
  EXPECT_EQ(b.z, 1.9);
}

TEST(Pose, QuaternionAndRotationAreTheSameTurn) {
  Pose pose;
  pose.yaw = 0.7;
  pose.pitch = -0.2;
  pose.roll = 0.4;
  const auto [x, y, z, w] = pose.ToQuaternion();
  const std::array<double, 9> m = {
      1 - 2 * (y * y + z * z), 2 * (x * y - z * w),     2 * (x * z + y * w),
      2 * (x * y + z * w),     1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
      2 * (x * z - y * w),     2 * (y * z + x * w),     1 - 2 * (x * x + y * y)};
  for (std::size_t i = 0; i < 9; ++i)
    EXPECT_NEAR(static_cast<double>(pose.ToRotation().m[i]), m[i], 1e-6) << i;
}

}  // namespace
}  // namespace lidar::synth
