// SPDX-License-Identifier: LGPL-2.1-or-later
// Origins and directions of a sensor's beams, column by column.
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
  /// Unit vector in the sensor frame, in scan number `scan`.
  Vec3 Direction(std::uint64_t scan, std::uint32_t beam, std::uint32_t column) const;
  /// Origin of a column's beams, in the sensor frame.
  Vec3 Origin(std::uint32_t column) const;
  /// Ranges are counted from this distance behind a beam's origin.
  float origin_m() const { return origin_m_; }

 private:
  Vec3 Fire(std::uint64_t scan, std::uint32_t laser, std::uint32_t column) const;

  RangeProjection projection_;
  const Firing* firing_;
  float origin_m_;
};

}  // namespace lidar::synth
