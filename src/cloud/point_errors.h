// SPDX-License-Identifier: LGPL-2.1-or-later
// Measures by how much a codec has moved the points of a cloud.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/cloud/point_fields.h"

namespace lidar {

struct PointErrors {
  std::uint64_t points = 0;   // number of compared points
  std::uint64_t missing = 0;  // returns of one cloud that the other cloud lacks
  double max_m = 0;
  double mean_m = 0;
  double rounding_m = 0;  // possible rounding error of positions as 32-bit floats
};

/// A decoded pixel or point. If a pixel has no return, all its values are 0.
struct DecodedPoint {
  std::array<float, 3> position{};  // m
  std::uint32_t range_mm = 0;       // 0 if only positions were coded
};

/// How a decoded point is assigned to a raw point.
enum class PointOrder {
  kPixels,  // the point in the same pixel
  kKept,    // the return with the same index
  // The nearest point, which may be assigned more than once. Errors are distances in both
  // directions.
  kAny,
};

/// Measures the distances between the points of `raw`, which must be whole points, and the decoded
/// points. If the points have no positions, the ranges of pixels are compared. If `thinned` is
/// true, points were removed on purpose, so points that are absent count as missing and not as
/// merged. Returns nothing if the numbers of pixels differ, or if `fields` has neither positions
/// nor ranges.
std::optional<PointErrors> MeasureErrors(ByteView raw, const PointFields& fields,
                                         std::uint32_t point_step,
                                         const std::vector<DecodedPoint>& decoded, PointOrder order,
                                         bool thinned = false);

}  // namespace lidar
