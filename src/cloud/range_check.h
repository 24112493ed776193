// SPDX-License-Identifier: LGPL-2.1-or-later
// Checks that the positions of points agree with their ranges and the sensor model.
#pragma once
#include <cstdint>
#include <optional>

#include "src/base/byte_reader.h"
#include "src/cloud/point_fields.h"
#include "src/cloud/range_projection.h"
#include "src/cloud/sensor_model.h"

namespace lidar {

/// Detects that an element between the source and the encoder has moved the points. If only ranges
/// were coded, the decoder would put these points back to their old positions.
class RangeCheck {
 public:
  /// Returns nothing if the fields do not have a range, or x, y and z as adjacent F32.
  static std::optional<RangeCheck> Create(const PointFields& fields, std::uint32_t point_step,
                                          const SensorModel& model);

  struct Contradiction {
    std::uint32_t beam = 0;
    std::uint32_t column = 0;  // measurement id
    // Distance between the point and the position that follows from its range.
    double distance_m = 0;
  };
  /// Checks kSamples returns of `raw`. Returns the first contradiction, or nothing if there is
  /// none. `raw` has all beams.
  std::optional<Contradiction> Find(ByteView raw, std::uint32_t first_column) const;

  static constexpr std::size_t kSamples = 4;

 private:
  RangeCheck(const PointFields& fields, std::uint32_t point_step, const SensorModel& model);

  std::size_t range_offset_;
  std::size_t xyz_offset_;
  std::uint32_t point_step_;
  std::uint32_t unit_mm_;
  RangeProjection projection_;
};

}  // namespace lidar
