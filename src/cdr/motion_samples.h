// SPDX-License-Identifier: LGPL-2.1-or-later
// The buffers of application/x-imu and application/x-odometry, little-endian.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/cdr/messages.h"

namespace lidar::gst {

/// Capture time [ns since the Unix epoch], acceleration [m/s^2], angular velocity [rad/s].
inline constexpr const char* kImuFields =
    "t:U64:0,ax:F32:8,ay:F32:12,az:F32:16,gx:F32:20,gy:F32:24,gz:F32:28";
inline constexpr std::size_t kImuSampleSize = 32;

std::vector<std::uint8_t> WriteImuSample(const cdr::Imu& imu);
/// As many messages as `bytes` have samples, with no orientation and no frame; none where a sample
/// is cut.
std::vector<cdr::Imu> ReadImuSamples(ByteView bytes);

/// Position [m], orientation x, y, z, w and how sure the pose is.
std::vector<std::uint8_t> WritePose(const cdr::Odometry& odometry);
/// The pose, with neither time nor frames; none where `bytes` are of another size.
std::optional<cdr::Odometry> ReadPose(ByteView bytes);

}  // namespace lidar::gst
