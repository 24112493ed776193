// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes clouds of any kind as plain Draco files (xyz geometry).
#pragma once
#include <cstdint>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/codec/cloud_io.h"

namespace lidar::draco {

using codec::XyzCloud;

/// Returns the longest side of the bounding box of the points [m].
double LongestSide(const XyzCloud& cloud);

enum class XyzMethod { kSequential, kKdTree };

struct XyzSettings {
  double max_error_m = 0.02;  // limit for the 3D error of each point
  double step_m = 0;          // step of the grid; 0: the largest that max_error_m allows
  int level = 7;              // Draco's compression level
  XyzMethod method = XyzMethod::kKdTree;
  unsigned intensity_bits = 0;
};

struct XyzResult {
  double step_m = 0;
  double error_m = 0;  // bound of the error with this step, including the rounding of floats
};

/// Appends a Draco file to `out`. The points must be finite. Returns false if there are no points,
/// or if no grid that Draco supports keeps the error within `max_error_m`. A grid has at most 2^30
/// cells along a side. Also, the floats of coordinates near 10 km are a millimetre apart.
bool EncodeXyz(const XyzCloud& cloud, const XyzSettings& settings, std::vector<std::uint8_t>* out,
               XyzResult* result);

/// Decodes a cloud that EncodeXyz() has written. Returns false for any other stream, and for a
/// cloud of more than `max_points` points.
bool DecodeXyz(ByteView stream, std::uint32_t max_points, XyzCloud* cloud);

}  // namespace lidar::draco
