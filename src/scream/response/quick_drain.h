// SPDX-License-Identifier: LGPL-2.1-or-later
// Extension capacity: the rate at which a backlog of the sender's queue leaves.
#pragma once
#include <algorithm>

#include "src/scream/model/path_model.h"
#include "src/scream/parameters.h"

namespace lidar::scream {

/// Returns the window's own rate, which exceeds the lowered target, limited by the acknowledged
/// rate. After a drop of the capacity the last round trips measured a queue that is gone, so the
/// link's time for the bytes in flight is used.
inline DataRate DrainRate(const Parameters& p, Time now, DataSize ref_wnd, DataSize in_flight,
                          const PathModel& path) {
  constexpr double kMargin = 1.25;
  const DataRate link = path.measured_capacity();
  Duration rtt = path.rtt().last();
  if (link > DataRate()) rtt = std::max(path.rtt().min(), std::min(rtt, in_flight / link));
  return std::min(ref_wnd / rtt / p.target_rate_divisor,
                  std::max(path.acked_rate(now) * kMargin, link));
}

}  // namespace lidar::scream
