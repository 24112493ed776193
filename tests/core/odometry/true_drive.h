// SPDX-License-Identifier: LGPL-2.1-or-later
// A synthetic drive with its scans and its gyroscope. Each pose of the drive is known.
#pragma once
#include "src/odometry/odometry.h"
#include "src/synth/imu.h"
#include "src/synth/scanner.h"

namespace lidar::odometry {

inline constexpr Duration kPeriod = std::chrono::milliseconds(100);

/// A car that has a sensor with 32 beams by default.
class Drive {
 public:
  Drive(synth::SceneKind scene, double speed_mps, std::uint64_t seed = 0)
      : Drive(Config(scene, speed_mps, seed)) {}
  explicit Drive(const synth::ScannerConfig& config)
      : columns_(config.sensor.model.columns_per_scan),
        scanner_(config),
        projection_(config.sensor.model) {}

  TimedPoints Scan(std::uint64_t number) {
    synth::Returns returns;
    scanner_.Cast(number, {0, columns_}, &returns);
    const auto& ranges = returns.range_mm;
    std::vector<float> xyz(3 * ranges.size());
    projection_.Project(ranges.data(), {0, columns_}, reinterpret_cast<std::uint8_t*>(xyz.data()),
                        3 * sizeof(float));
    TimedPoints timed;
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      if (ranges[i] == 0) continue;
      timed.points.push_back(
          Eigen::Vector3f(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]).cast<double>());
      timed.phases.push_back(static_cast<float>(i % columns_) / static_cast<float>(columns_));
      timed.rings.push_back(static_cast<std::uint16_t>(i / columns_));
    }
    return timed;
  }
  Time StartOf(std::uint64_t number) const { return Time{} + scanner_.ColumnTime(number, 0); }
  Pose TruthAt(Time t) const {
    const synth::Pose pose = scanner_.trajectory().At(t.time_since_epoch());
    const auto [x, y, z, w] = pose.ToQuaternion();
    return {Eigen::Quaterniond(w, x, y, z), {pose.x, pose.y, pose.z}};
  }
  synth::Imu Imu() const { return {scanner_.trajectory(), synth::kMemsImu, 7}; }
  /// Returns the motion from the middle of the first scan to the middle of scan `number`.
  Pose WayTo(std::uint64_t number) const {
    return TruthAt(StartOf(0) + kPeriod / 2).Inverse() * TruthAt(StartOf(number) + kPeriod / 2);
  }

  static synth::ScannerConfig Config(synth::SceneKind scene, double speed_mps, std::uint64_t seed,
                                     const char* sensor = "os0-32", std::uint32_t columns = 512) {
    synth::ScannerConfig config;
    config.sensor = *synth::MakeSensor(sensor, columns);
    config.scene = scene;
    config.speed_mps = speed_mps;
    config.seed = seed;
    return config;
  }

 private:
  std::uint32_t columns_;
  synth::Scanner scanner_;
  RangeProjection projection_;
};

/// Adds the angular velocities before `end`, as a gyroscope measures them whose axes are turned by
/// `axes_rad` about the vertical.
inline void AddTurns(synth::Imu* imu, Time end, double axes_rad, Odometry* odometry) {
  const Eigen::AngleAxisd axes(axes_rad, Eigen::Vector3d::UnitZ());
  for (const ImuSample& s : imu->Until(end.time_since_epoch()))
    odometry->OnTurn(s.time, axes * Eigen::Vector3d(s.angular_velocity.data()));
}

}  // namespace lidar::odometry
