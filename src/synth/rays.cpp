// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/synth/rays.h"

#include <cmath>

namespace lidar::synth {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

Vec3 ToVec3(const std::array<float, 3>& a) { return {a[0], a[1], a[2]}; }

}  // namespace

Rays::Rays(const Sensor& sensor)
    : projection_(sensor.model),
      firing_(sensor.firing),
      origin_m_(static_cast<float>(
          std::hypot(sensor.model.beam_to_lidar_x_m, sensor.model.beam_to_lidar_z_m))) {}

Vec3 Rays::Direction(std::uint64_t scan, std::uint32_t beam, std::uint32_t column) const {
  return firing_ != nullptr ? Fire(scan, beam, column)
                            : ToVec3(projection_.Direction(beam, column));
}

/// Computes the origin by a step back along the beam, from the beam's point at a range of 1 m.
Vec3 Rays::Origin(std::uint32_t column) const {
  if (firing_ != nullptr) return {};
  const Vec3 at_1m = ToVec3(projection_.Point(0, column, 1000));
  return at_1m - (1.0F - origin_m_) * ToVec3(projection_.Direction(0, column));
}

Vec3 Rays::Fire(std::uint64_t scan, std::uint32_t laser, std::uint32_t column) const {
  const Firing& f = *firing_;
  const double scan_ns = 1e9 / Firing::kScansPerSecond;
  const double scans = static_cast<double>(scan) + static_cast<double>(column) / f.columns +
                       laser * f.laser_delay_ns / scan_ns;
  const double sweeps = scans * f.sweeps;
  double azimuth =
      f.first_azimuth + f.view * (sweeps - std::floor(sweeps)) + laser % f.banks * f.bank_azimuth;
  const double off = f.fan * (laser - (f.lasers - 1) / 2.0);
  const double rise = off * std::sin(azimuth * kDegree);
  azimuth += off * std::cos(azimuth * kDegree);
  if (f.azimuth_unit > 0) azimuth = std::round(azimuth / f.azimuth_unit) * f.azimuth_unit;
  const double elevation =
      (f.ElevationOf(laser) + rise + f.swing * std::sin(360 * kDegree * scans * f.swings)) *
      kDegree;
  const double horizontal = std::cos(elevation);
  return {static_cast<float>(horizontal * std::cos(azimuth * kDegree)),
          static_cast<float>(-horizontal * std::sin(azimuth * kDegree)),
          static_cast<float>(std::sin(elevation))};
}

}  // namespace lidar::synth
