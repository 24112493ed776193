// SPDX-License-Identifier: LGPL-2.1-or-later
// Measures how far a received cloud is from the sent one.
#pragma once
#include <cstdint>

#include "src/tools/bench/demo/cloud_frame.h"

namespace lidar::demo {

struct Comparison {
  std::uint64_t points = 0;   // number of returns that were compared
  std::uint64_t missing = 0;  // number of sent returns that did not arrive
  std::uint64_t added = 0;    // number of received points where the sent cloud has no return
  double max_error_m = 0;
  double sum_error_m = 0;

  Comparison& operator+=(const Comparison& o);
};

/// Compares two clouds. If both are organised and have the same shape, compares them pixel by
/// pixel. Otherwise compares each point of both clouds with the nearest point of the other cloud,
/// up to a distance of `reach_m`. A point whose coordinates are all 0 is a missing return.
Comparison Compare(const Cloud& sent, const Cloud& received, double reach_m);

}  // namespace lidar::demo
