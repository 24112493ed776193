// SPDX-License-Identifier: LGPL-2.1-or-later
// Computes the origins and the directions of a sensor's beams, column by column.
#pragma once
#include <cstdint>

#include "src/cloud/range_projection.h"
#include "src/synth/geometry.h"
#include "src/synth/sensors.h"

namespace lidar::synth {

class Rays {
 public:
  explicit Rays(const Sensor& sensor);

  std::uint32_t beams() const { return projection_.beams(); }
  std::uint32_t columns() const { return projection_.columns(); }
  /// Returns the direction of a beam in scan number `scan`, as a unit vector in the sensor frame.
  Vec3 Direction(std::uint64_t scan, std::uint32_t beam, std::uint32_t column) const;
  /// Returns the origin of a column's beams in the sensor frame.
  Vec3 Origin(std::uint32_t column) const;
  /// Returns the range at the origin of a beam. Ranges are counted from a point this far behind the
  /// origin.
  float origin_m() const { return origin_m_; }

 private:
  Vec3 Fire(std::uint64_t scan, std::uint32_t laser, std::uint32_t column) const;

  RangeProjection projection_;
  const Firing* firing_;
  float origin_m_;
};

}  // namespace lidar::synth
