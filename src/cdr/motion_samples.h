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
/// Returns a message for each sample in `bytes`, without orientation and frame, or no messages if
/// the last sample is cut.
std::vector<Imu> ReadImuSamples(ByteView bytes);

/// Writes position [m], orientation x, y, z, w, `tracking` (Odometry has none), and the pose's
/// covariance unless it is zero.
std::vector<std::uint8_t> WritePose(const Odometry& odometry, std::uint64_t tracking);
/// Returns the pose without time and frames, with its covariance (zeros if unknown). Returns
/// nothing if `bytes` have another size.
std::optional<Odometry> ReadPose(ByteView bytes, std::uint64_t* tracking);

}  // namespace lidar::cdr
