// SPDX-License-Identifier: LGPL-2.1-or-later
// How many bytes a pose has in buffers of application/x-odometry, little-endian.
#pragma once
#include <cstddef>

namespace lidar {

/// Position and orientation in seven doubles, and how sure the pose is in an integer; then, where
/// it is known, the covariance in 36 doubles.
inline constexpr std::size_t kPoseSize = 64;
inline constexpr std::size_t kPoseSizeWithCovariance = kPoseSize + 36 * sizeof(double);

}  // namespace lidar
