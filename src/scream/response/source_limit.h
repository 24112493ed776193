// SPDX-License-Identifier: LGPL-2.1-or-later
// Extension capacity: the window where the streams' maximum, and not the link, limits what is sent.
#pragma once
#include <algorithm>

#include "src/scream/model/path_model.h"
#include "src/scream/parameters.h"

namespace lidar::scream {

struct SourceLimit {
  const Parameters& p;
  const PathModel& path;
  DataRate max_bitrate;  ///< of all streams
  double queue_compensation = 0;

  /// What the maximum bitrate needs where its frames leave in bursts.
  DataSize Window() const {
    constexpr Duration kReporting = std::chrono::milliseconds(1);
    return max_bitrate * (path.rtt().smoothed() + kReporting) *
           (p.target_rate_divisor + queue_compensation) * p.packet_pacing_headroom;
  }
  /// The window must not drift away from what is in flight.
  DataSize LargestWindow() const { return std::max(path.max_in_flight().longest(), Window()); }
  /// At the maximum bitrate a window is enough for frames that leave evenly; a whole scan, and what
  /// a gap left, would go out faster.
  bool HoldsBurstsBack(DataSize ref_wnd) const {
    return p.extensions.capacity && max_bitrate < DataRate::Infinite() && ref_wnd < Window() &&
           path.max_in_flight().lately() > ref_wnd;
  }
};

}  // namespace lidar::scream
