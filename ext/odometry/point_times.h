// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads when points were sampled, from the fields of common drivers.
#pragma once
#include <cstdint>
#include <vector>

#include "src/cloud/point_fields.h"

namespace lidar::gst {

/// Returns the field with the time of a point: `t`, `time`, `timestamp`, `time_stamp` or
/// `offset_time`. Returns null if the cloud has none.
const PointField* TimeFieldOf(const PointFields& fields);

struct PointsInMemory {
  const std::uint8_t* bytes;
  std::size_t count;
  std::uint32_t step;        // bytes
  std::uint32_t xyz_offset;  // of x, y and z, each an F32
};

/// Returns the seconds from the first sample to each point. Drivers count from the cloud's start,
/// 1970 or power-on, in seconds, milliseconds, microseconds or nanoseconds. The unit is the one in
/// which the samples last about as long as `sweep_s`. Returns an empty vector if no unit fits.
std::vector<float> SecondsOf(const PointField& field, const PointsInMemory& points, double sweep_s);

}  // namespace lidar::gst
