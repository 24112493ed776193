// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts IMU samples and poses between GStreamer's buffers (little-endian) and ROS messages.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/imu_sample.h"
#include "src/cdr/messages.h"

namespace lidar::cdr {

std::vector<std::uint8_t> WriteImuSample(const Imu& imu);
/// Returns a message for each sample in `bytes`, without orientation and frame. Returns no messages
/// if the last sample is incomplete.
std::vector<Imu> ReadImuSamples(ByteView bytes);

/// Writes the position [m], the orientation (x, y, z, w), and `tracking`, which Odometry does not
/// have. Also writes the pose's covariance unless it is zero.
std::vector<std::uint8_t> WritePose(const Odometry& odometry, std::uint64_t tracking);
/// Reads a pose and `tracking`. The pose has no time and no frames. Its covariance is zero if it is
/// unknown. Returns nothing if the size of `bytes` is wrong.
std::optional<Odometry> ReadPose(ByteView bytes, std::uint64_t* tracking);

}  // namespace lidar::cdr
