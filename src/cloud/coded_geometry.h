// SPDX-License-Identifier: LGPL-2.1-or-later
// The kinds of geometry of a coded slice. Their numbers are part of the stream format.
#pragma once
#include <cstdint>

namespace lidar {

enum class Geometry : std::uint8_t {
  kXyz = 0,    // coordinates of each point
  kRange = 1,  // ranges along the beams of a sensor
};

}  // namespace lidar
