// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts ranges to points. Supports sensors with turning beams and sensors with an angle per
// pixel.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "src/cloud/range_projection.h"
#include "src/ouster/metadata.h"

namespace lidar::ouster {

/// The projection of a sensor. It is immutable, so several threads may use the same object.
class PixelProjection {
 public:
  explicit PixelProjection(const Metadata& metadata);

  /// Returns x, y and z [m] of a return at `range_mm`, which must not be 0.
  std::array<float, 3> Point(std::uint32_t beam, std::uint32_t column,
                             std::uint32_t range_mm) const {
    if (spinning_) return spinning_->Point(beam, column, range_mm);
    const Vector& d = directions_[std::size_t{beam} * columns_ + column];
    const float r = static_cast<float>(range_mm) * 1e-3F - beam_origin_m_;
    return {r * d[0] + offset_[0], r * d[1] + offset_[1], r * d[2] + offset_[2]};
  }
  /// Returns the unit vector along which the point moves if its range grows.
  std::array<float, 3> Direction(std::uint32_t beam, std::uint32_t column) const;

 private:
  using Vector = std::array<float, 3>;

  std::optional<RangeProjection> spinning_;
  std::uint32_t columns_ = 0;
  std::vector<Vector> directions_;  // beams x columns, row-major
  Vector offset_{};                 // position of the beams' origin in the sensor frame [m]
  float beam_origin_m_ = 0;         // length of the vector beam_to_lidar [m]
};

}  // namespace lidar::ouster
