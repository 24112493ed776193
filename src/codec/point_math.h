// SPDX-License-Identifier: LGPL-2.1-or-later
// What several judges of points ask of their bytes.
#pragma once
#include <cstdint>
#include <cstring>

namespace lidar::codec {

/// The field `range` [mm] at `bytes`; 0: no return.
inline std::uint32_t RangeAt(const std::uint8_t* bytes) {
  std::uint32_t range = 0;
  std::memcpy(&range, bytes, sizeof range);
  return range;
}

/// Between two points of three coordinates.
inline double SquaredDistance(const float* a, const float* b) {
  double sum = 0;
  for (unsigned k = 0; k < 3; ++k) {
    const double d = static_cast<double>(a[k]) - static_cast<double>(b[k]);
    sum += d * d;
  }
  return sum;
}

}  // namespace lidar::codec
