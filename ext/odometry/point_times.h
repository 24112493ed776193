// SPDX-License-Identifier: LGPL-2.1-or-later
// When points were sampled, by the fields that drivers give them.
#pragma once
#include <cstdint>
#include <vector>

#include "src/cloud/point_fields.h"

namespace lidar::gst {

/// The field with the time of a point: `t`, `time`, `timestamp`, `time_stamp` or `offset_time`;
/// null without it.
const PointField* TimeFieldOf(const PointFields& fields);

struct PointsInMemory {
  const std::uint8_t* bytes;
  std::size_t count;
  std::uint32_t step;        // bytes
  std::uint32_t xyz_offset;  // of x, y and z as F32
};

/// Seconds since the first sample, for each point. Drivers count from the cloud, 1970 or power-on
/// in seconds, milliseconds, microseconds or nanoseconds: the unit is the one in which the samples
/// last about as long as `sweep_s`. Empty if they do in no unit.
std::vector<float> SecondsOf(const PointField& field, const PointsInMemory& points, double sweep_s);

}  // namespace lidar::gst
