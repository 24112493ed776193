// SPDX-License-Identifier: LGPL-2.1-or-later
// Clouds of sensors with known beams. The tests of the beam tables and of the cloud codec use them.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace lidar::codec::cloud {

/// The x, y, z and intensity of each point.
using PlainPoints = std::vector<std::array<float, 4>>;

/// Returns the points that a sensor of 16 beams and 450 columns measures in a room. Each azimuth
/// has an error of up to `jitter_deg`. One pixel in twenty has two or three returns.
inline PlainPoints SpinningScan(double jitter_deg) {
  std::mt19937 random(9);
  PlainPoints points;
  for (int column = 0; column < 450; ++column) {
    for (int beam = 0; beam < 16; ++beam) {
      const double jitter = jitter_deg * (static_cast<double>(random() % 2'001) / 1'000 - 1);
      const double azimuth = (column * 0.8 + 0.1 * beam + jitter) * M_PI / 180;
      const double elevation = (2.0 * beam - 15) * M_PI / 180;
      const double wall =
          std::min(10 / std::abs(std::cos(azimuth)), 6 / std::abs(std::sin(azimuth)));
      const int returns = random() % 20 == 0 ? 2 + static_cast<int>(random() % 2) : 1;
      for (int i = 0; i < returns; ++i) {
        const double range = 1e-3 * std::round(1e3 * wall / std::cos(elevation)) + 1.5 * i;
        const double rho = range * std::cos(elevation);
        points.push_back({static_cast<float>(rho * std::cos(azimuth)),
                          static_cast<float>(rho * std::sin(azimuth)),
                          static_cast<float>(range * std::sin(elevation)),
                          static_cast<float>(points.size() % 256)});
      }
    }
  }
  return points;
}

/// Returns the points that 12 beams of an oscillating mirror measure. Each beam traces a bent line,
/// and the lower beams bend a bit more. The columns are 0.2 degrees apart, give or take 2 %. The
/// whole scan is turned by `turn_deg`.
inline PlainPoints BendingScan(double turn_deg) {
  const auto rounded = [](double degrees) { return std::round(100 * degrees) * 0.01 * M_PI / 180; };
  PlainPoints points;
  for (int column = -300; column < 300; ++column) {
    const double degrees = 0.2 * column - 0.4 * std::cos(0.01 * column);
    for (int beam = 0; beam < 12; ++beam) {
      const double azimuth = rounded(degrees + 0.07 * (beam % 3) + turn_deg);
      const double bend = 1e-6 * column * column * (1 + 0.1 * beam);
      const double elevation = rounded(8 - 0.8 * beam + bend);
      const double range = 0.004 * std::round(2'500 / std::cos(0.003 * column)) + 4 * (beam % 2);
      const double rho = range * std::cos(elevation);
      points.push_back({static_cast<float>(rho * std::cos(azimuth)),
                        static_cast<float>(rho * std::sin(azimuth)),
                        static_cast<float>(range * std::sin(elevation)),
                        static_cast<float>(points.size() % 256)});
    }
  }
  std::shuffle(points.begin(), points.end(), std::mt19937(5));
  return points;
}

/// A point of a cloud that livox_ros_driver2 publishes, without the field `tag`.
struct PathPoint {
  float x, y, z;
  float intensity;
  double timestamp;  // [ns]
  std::uint8_t line;
};
using PathCloud = std::vector<PathPoint>;

/// Returns the points that four lasers measure in a room by way of a mirror. The room has no
/// ceiling, so steep directions give no points. The mirror makes 7.3 turns per scan and tilts up
/// and down. Each direction has an error of up to `shake_deg`.
inline PathCloud PathScan(unsigned scan, double shake_deg = 0) {
  constexpr int kFirings = 4'000;
  std::mt19937 random(scan);
  std::uniform_real_distribution<double> shake(-shake_deg * M_PI / 180, shake_deg * M_PI / 180);
  PathCloud points;
  for (int firing = 0; firing < kFirings; ++firing) {
    const double scans = scan + 1.0 * firing / kFirings;
    const double turn = -2 * M_PI * 7.3 * scans;
    const double tilt = 0.6 + 0.2 * std::sin(2 * M_PI * 1.1 * scans);
    const double fan = 0.03 * (firing % 4 - 1.5);
    const std::array<double, 3> normal = {std::sin(tilt) * std::cos(turn),
                                          std::sin(tilt) * std::sin(turn), -std::cos(tilt)};
    const double along = 2 * (std::sin(fan) * normal[0] + std::cos(fan) * normal[2]);
    const std::array<double, 3> beam = {std::sin(fan) - along * normal[0], -along * normal[1],
                                        std::cos(fan) - along * normal[2]};
    const double elevation = std::asin(beam[2]) + shake(random);
    const double azimuth = std::atan2(beam[1], beam[0]) + shake(random);
    if (elevation > 0.6) continue;
    const double wall = std::min(10 / std::abs(std::cos(azimuth)), 6 / std::abs(std::sin(azimuth)));
    const double range = 1e-3 * std::round(1e3 * wall / std::cos(elevation));
    const double rho = range * std::cos(elevation);
    points.push_back(
        {static_cast<float>(rho * std::cos(azimuth)), static_cast<float>(rho * std::sin(azimuth)),
         static_cast<float>(range * std::sin(elevation)), static_cast<float>(points.size() % 256),
         1.7e18 + 1e8 * scans, static_cast<std::uint8_t>(firing % 4)});
  }
  return points;
}

}  // namespace lidar::codec::cloud
