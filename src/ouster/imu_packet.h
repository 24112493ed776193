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

/// Values in the IMU's frame; Metadata::imu_to_sensor converts them to the sensor's.
struct ImuSample {
  std::uint64_t timestamp = 0;              // ns of the sensor's clock
  std::array<float, 3> acceleration{};      // m/s^2
  std::array<float, 3> angular_velocity{};  // rad/s
};

/// Returns true if `bytes` have the size of an IMU packet. A sensor whose IMU is off has none.
bool IsImuPacket(ByteView bytes, const Metadata& metadata);

/// Returns nothing unless `bytes` are exactly one IMU packet. Samples that the sensor marks as
/// invalid are left out.
std::optional<std::vector<ImuSample>> ParseImuPacket(ByteView bytes, const Metadata& metadata);

/// Returns the offsets of the timestamps in an IMU packet [byte].
std::vector<std::size_t> ImuTimestamps(const Metadata& metadata);

}  // namespace lidar::ouster
