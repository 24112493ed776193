// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads the packets of a sensor's inertial measurement unit.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/ouster/metadata.h"

namespace lidar::ouster {

/// A sample in the coordinate frame of the IMU. Metadata::imu_to_sensor converts it to the sensor's
/// frame.
struct ImuSample {
  std::uint64_t timestamp = 0;              // ns of the sensor's clock
  std::array<float, 3> acceleration{};      // m/s^2
  std::array<float, 3> angular_velocity{};  // rad/s
};

/// Returns true if `bytes` have the size of an IMU packet. Returns false for every packet if the
/// sensor's IMU is switched off.
bool IsImuPacket(ByteView bytes, const Metadata& metadata);

/// Returns the samples of an IMU packet, except samples that the sensor marks as invalid. Returns
/// nothing unless `bytes` are exactly one IMU packet.
std::optional<std::vector<ImuSample>> ParseImuPacket(ByteView bytes, const Metadata& metadata);

/// Returns the offsets of all timestamps in an IMU packet [bytes].
std::vector<std::size_t> ImuTimestamps(const Metadata& metadata);

}  // namespace lidar::ouster
