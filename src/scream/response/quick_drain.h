// SPDX-License-Identifier: LGPL-2.1-or-later
// Extension quick_drain: how fast a backlog of the sender's queue leaves.
#pragma once
#include <algorithm>

#include "src/scream/model/path_model.h"
#include "src/scream/parameters.h"

namespace lidar::scream {

/// The window's own rate, which the lowered target is below, but not much more than packets
/// arrive at.
inline DataRate DrainRate(const Parameters& p, Time now, DataSize ref_wnd, const PathModel& path) {
  constexpr double kMargin = 1.25;
  return std::min(ref_wnd / path.rtt().last() / p.target_rate_divisor,
                  path.acked_rate(now) * kMargin);
}

}  // namespace lidar::scream
