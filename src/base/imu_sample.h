// SPDX-License-Identifier: LGPL-2.1-or-later
// A sample of an inertial measurement unit, and its bytes in buffers of application/x-imu.
#pragma once
#include <algorithm>
#include <array>
#include <vector>

#include "src/base/byte_writer.h"
#include "src/base/time.h"

namespace lidar {

/// A sample, in the frame of the unit. At rest the acceleration is 9.8 m/s^2 upwards.
struct ImuSample {
  Time time{};                               // capture time since the Unix epoch
  std::array<double, 3> acceleration{};      // [m/s^2]
  std::array<double, 3> angular_velocity{};  // [rad/s]
};

inline constexpr const char* kImuFields =
    "t:U64:0,ax:F32:8,ay:F32:12,az:F32:16,gx:F32:20,gy:F32:24,gz:F32:28";
inline constexpr std::size_t kImuSampleSize = 32;

/// Appends the little-endian bytes of a sample, in the layout of kImuFields.
inline void WriteImuSample(const ImuSample& sample, std::vector<std::uint8_t>* out) {
  ByteWriter w(out);
  w.Le64(static_cast<std::uint64_t>(
      std::max<std::int64_t>(sample.time.time_since_epoch().count(), 0)));
  for (const double v : sample.acceleration) w.LeF32(static_cast<float>(v));
  for (const double v : sample.angular_velocity) w.LeF32(static_cast<float>(v));
}

}  // namespace lidar
