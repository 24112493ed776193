// SPDX-License-Identifier: LGPL-2.1-or-later
// Measures how far a codec has moved the points of a cloud.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/cloud/point_fields.h"

namespace lidar {

struct PointErrors {
  std::uint64_t points = 0;   // compared
  std::uint64_t missing = 0;  // returns of one cloud without a partner in the other
  double max_m = 0;
  double mean_m = 0;
  double rounding_m = 0;  // rounding of the positions by 32-bit floats
};

/// A pixel without a return is all zero.
struct DecodedPoint {
  std::array<float, 3> position{};  // m
  std::uint32_t range_mm = 0;       // 0 if only positions were coded
};

/// Rule that assigns a raw point to a decoded point.
enum class PointOrder {
  kPixels,  // the point of the same pixel
  kKept,    // the return with the same number
  kAny,     // the nearest point, possibly shared; errors are distances in both directions
};

/// Measures the distances between `raw`, which has whole points, and its decoded points. Pixels
/// without positions are compared by range. With `thinned`, points were removed on purpose: absent
/// points are missing, not merged. Returns nothing if the numbers of pixels differ, or if `fields`
/// lack the values to compare.
std::optional<PointErrors> MeasureErrors(ByteView raw, const PointFields& fields,
                                         std::uint32_t point_step,
                                         const std::vector<DecodedPoint>& decoded, PointOrder order,
                                         bool thinned = false);

}  // namespace lidar
