// SPDX-License-Identifier: LGPL-2.1-or-later
// Measures how far the points of a cloud have moved on their way through a codec.
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
  std::uint64_t missing = 0;  // returns of the cloud that did not come back, or the other way round
  double max_m = 0;
  double mean_m = 0;
  double rounding_m = 0;  // rounding of the positions by 32-bit floats
};

/// A pixel without a return is all zero.
struct DecodedPoint {
  std::array<float, 3> position{};  // m
  std::uint32_t range_mm = 0;       // 0 if only positions were coded
};

/// Which point of the raw cloud a decoded point stands for.
enum class PointOrder {
  kPixels,  // the point at the same place
  kKept,    // the same one of the returns
  kAny,     // the nearest one, also of several; errors are distances in both directions
};

/// The distances between the points of `raw`, which is whole points, and their decoded points.
/// Pixels without positions are compared by range. `thinned`: points were left out on purpose, so
/// fewer points are missing, not merged. Returns nothing if pixels are not as many, or there are no
/// points to compare.
std::optional<PointErrors> MeasureErrors(ByteView raw, const PointFields& fields,
                                         std::uint32_t point_step,
                                         const std::vector<DecodedPoint>& decoded, PointOrder order,
                                         bool thinned = false);

}  // namespace lidar
