// SPDX-License-Identifier: LGPL-2.1-or-later
// Extension capacity: the window while the streams' maximum, not the link, limits the rate.
#pragma once
#include <algorithm>

#include "src/scream/model/path_model.h"
#include "src/scream/parameters.h"

namespace lidar::scream {

struct SourceLimit {
  const Parameters& p;
  const PathModel& path;
  DataRate max_bitrate;  ///< maximum of all streams
  double queue_compensation = 0;

  /// Returns the window that the maximum bitrate needs if frames leave in bursts.
  DataSize Window() const {
    constexpr Duration kReporting = std::chrono::milliseconds(1);
    return max_bitrate * (path.rtt().smoothed() + kReporting) *
           (p.target_rate_divisor + queue_compensation) * p.packet_pacing_headroom;
  }
  /// Returns a limit that keeps the window near the bytes in flight.
  DataSize LargestWindow() const { return std::max(path.max_in_flight().longest(), Window()); }
  /// Returns true if the window delays bursts at the maximum bitrate. It suffices for frames that
  /// leave evenly; whole scans, and data from a gap, could leave faster.
  bool HoldsBurstsBack(DataSize ref_wnd) const {
    return p.extensions.capacity && max_bitrate < DataRate::Infinite() && ref_wnd < Window() &&
           path.max_in_flight().lately() > ref_wnd;
  }
};

}  // namespace lidar::scream
