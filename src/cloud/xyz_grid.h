// SPDX-License-Identifier: LGPL-2.1-or-later
// The grid on which coordinates are rounded: cubes that decode to their middles.
#pragma once

namespace lidar {

/// Distance between the middle and a corner of a cube whose sides are 1: sqrt(3) / 2. No point of a
/// cube moves further.
constexpr double kXyzErrorPerStep = 0.8660254037844386;

}  // namespace lidar
