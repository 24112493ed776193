// SPDX-License-Identifier: LGPL-2.1-or-later
// xyz geometry: clouds of any kind as plain Draco files.
#pragma once
#include <cstdint>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/codec/cloud_io.h"

namespace lidar::draco {

using codec::XyzCloud;

/// Longest side of the points' box [m].
double LongestSide(const XyzCloud& cloud);

enum class XyzMethod { kSequential, kKdTree };

struct XyzSettings {
  double max_error_m = 0.02;  // bound of the 3D error of every point
  double step_m = 0;          // of the grid; 0: the coarsest that max_error_m allows
  int level = 7;              // Draco's compression level
  XyzMethod method = XyzMethod::kKdTree;
  unsigned intensity_bits = 0;
};

struct XyzResult {
  double step_m = 0;
  double error_m = 0;  // bound that holds with this step, float rounding included
};

/// Appends a Draco file to `out`. The points must be finite. Returns false if there are none, or if
/// no grid that Draco can write meets the bound. A grid has at most 2^30 cells along a side, and
/// floats at 10 km have steps of a millimetre.
bool EncodeXyz(const XyzCloud& cloud, const XyzSettings& settings, std::vector<std::uint8_t>* out,
               XyzResult* result);

/// Returns false for a stream that is not a cloud of 1 .. max_points points as EncodeXyz writes
/// them.
bool DecodeXyz(ByteView stream, std::uint32_t max_points, XyzCloud* cloud);

}  // namespace lidar::draco
