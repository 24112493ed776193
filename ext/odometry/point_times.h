// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads the sampling times of points from the fields that common drivers use.
#pragma once
#include <cstdint>
#include <vector>

#include "src/cloud/point_fields.h"

namespace lidar::gst {

/// Returns the field with the time of a point, or null if the cloud has none. The field is called
/// `t`, `time`, `timestamp`, `time_stamp` or `offset_time`.
const PointField* TimeFieldOf(const PointFields& fields);

struct PointsInMemory {
  const std::uint8_t* bytes;
  std::size_t count;
  std::uint32_t step;        // size of a point [bytes]
  std::uint32_t xyz_offset;  // offset of x, y and z, each an F32
};

/// Returns the time of each point since the first sample [s]. Drivers count times from the start of
/// the cloud, from 1970 or from power-on, in seconds, milliseconds, microseconds or nanoseconds.
/// The unit is chosen so that the samples last about as long as `sweep_s`. Returns an empty vector
/// if no unit matches.
std::vector<float> SecondsOf(const PointField& field, const PointsInMemory& points, double sweep_s);

}  // namespace lidar::gst
