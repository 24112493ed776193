// SPDX-License-Identifier: LGPL-2.1-or-later
// Common functions on points.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace lidar {

constexpr double kPi = 3.14159265358979323846;

/// The field `range` [mm] at `bytes`; 0: no return.
inline std::uint32_t RangeAt(const std::uint8_t* bytes) {
  std::uint32_t range = 0;
  std::memcpy(&range, bytes, sizeof range);
  return range;
}

/// The fields x, y and z [m] at `bytes`.
inline std::array<float, 3> PositionAt(const std::uint8_t* bytes) {
  std::array<float, 3> p;
  std::memcpy(p.data(), bytes, sizeof p);
  return p;
}

inline bool IsFinite(const std::array<float, 3>& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

/// Sensors write a missing return as a point that is all zero, or not finite.
inline bool IsReturn(const std::array<float, 3>& p) {
  return IsFinite(p) && (p[0] != 0 || p[1] != 0 || p[2] != 0);
}

/// Square of the distance between two points of three coordinates.
inline double SquaredDistance(const float* a, const float* b) {
  double sum = 0;
  for (unsigned k = 0; k < 3; ++k) {
    const double d = static_cast<double>(a[k]) - static_cast<double>(b[k]);
    sum += d * d;
  }
  return sum;
}

}  // namespace lidar
