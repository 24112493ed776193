// SPDX-License-Identifier: LGPL-2.1-or-later
// Functions on points that several files use.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace lidar {

constexpr double kPi = 3.14159265358979323846;

/// Reads the field `range` [mm] at `bytes`. A range of 0 means no return.
inline std::uint32_t RangeAt(const std::uint8_t* bytes) {
  std::uint32_t range = 0;
  std::memcpy(&range, bytes, sizeof range);
  return range;
}

/// Reads the fields x, y and z [m] at `bytes`.
inline std::array<float, 3> PositionAt(const std::uint8_t* bytes) {
  std::array<float, 3> p;
  std::memcpy(p.data(), bytes, sizeof p);
  return p;
}

inline bool IsFinite(const std::array<float, 3>& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

/// Returns true if `p` is a return. A missing return is a point that is all zero or not finite.
inline bool IsReturn(const std::array<float, 3>& p) {
  return IsFinite(p) && (p[0] != 0 || p[1] != 0 || p[2] != 0);
}

inline double SquaredDistance(const float* a, const float* b) {
  double sum = 0;
  for (unsigned k = 0; k < 3; ++k) {
    const double d = static_cast<double>(a[k]) - static_cast<double>(b[k]);
    sum += d * d;
  }
  return sum;
}

}  // namespace lidar
