// SPDX-License-Identifier: LGPL-2.1-or-later
// The geometries of coded slices, and their numbers in a stream.
#pragma once
#include <cstdint>

namespace lidar {

enum class Geometry : std::uint8_t {
  kXyz = 0,    // coordinates of single points
  kRange = 1,  // ranges along the beams of a sensor
};

}  // namespace lidar
