// SPDX-License-Identifier: LGPL-2.1-or-later
// Size of a pose in buffers of application/x-odometry, little-endian.
#pragma once
#include <cstddef>

namespace lidar {

/// Seven doubles with position and orientation, and an integer with the tracking; then, if known,
/// the covariance in 36 doubles.
inline constexpr std::size_t kPoseSize = 64;
inline constexpr std::size_t kPoseSizeWithCovariance = kPoseSize + 36 * sizeof(double);

}  // namespace lidar
