// SPDX-License-Identifier: LGPL-2.1-or-later
// Measures how far a received cloud is from the sent one.
#pragma once
#include <cstdint>

#include "src/tools/bench/demo/cloud_frame.h"

namespace lidar::demo {

struct Comparison {
  std::uint64_t points = 0;   // returns compared
  std::uint64_t missing = 0;  // returns that did not arrive
  std::uint64_t added = 0;    // points where the sent cloud has no return
  double max_error_m = 0;
  double sum_error_m = 0;

  Comparison& operator+=(const Comparison& o);
};

/// Compares organised clouds of equal shape pixel by pixel. Otherwise compares each point with the
/// nearest one of the other cloud within `reach_m`, in both directions. All-zero points are missing
/// returns.
Comparison Compare(const Cloud& sent, const Cloud& received, double reach_m);

}  // namespace lidar::demo
