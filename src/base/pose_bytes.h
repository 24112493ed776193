// SPDX-License-Identifier: LGPL-2.1-or-later
// The size of a pose in buffers of application/x-odometry (little-endian).
#pragma once
#include <cstddef>

namespace lidar {

/// A pose consists of seven doubles (position and orientation) and a 64-bit integer (the state of
/// tracking). If the covariance is known, 36 doubles follow.
inline constexpr std::size_t kPoseSize = 64;
inline constexpr std::size_t kPoseSizeWithCovariance = kPoseSize + 36 * sizeof(double);

}  // namespace lidar
