// SPDX-License-Identifier: LGPL-2.1-or-later
// The grid on which coordinates are rounded. Its cells are cubes, and a cube is decoded to its
// middle.
#pragma once

namespace lidar {

/// The distance from the middle to a corner of a cube with sides of length 1: sqrt(3) / 2. No point
/// in the cube is moved by more than this.
constexpr double kXyzErrorPerStep = 0.8660254037844386;

}  // namespace lidar
