// SPDX-License-Identifier: LGPL-2.1-or-later
// The extension capacity: the window while the maximum bitrate of the streams, and not the link,
// limits the rate.
#pragma once
#include "src/scream/model/path_model.h"
#include "src/scream/parameters.h"
#include "src/scream/streams.h"

namespace lidar::scream {

/// Returns the window that the maximum bitrate needs if frames leave in bursts.
inline DataSize BurstWindow(const Parameters& p, const PathModel& path, const Streams& streams) {
  constexpr Duration kReporting = 1ms;
  return streams.max_bitrate() * (path.rtt().smoothed() + kReporting) *
         (p.target_rate_divisor + streams.queue_compensation()) * p.packet_pacing_headroom;
}

/// Returns true if the window delays bursts at the maximum bitrate. A window that is large enough
/// for frames at an even pace may still delay whole scans, and data that were queued in a gap.
inline bool HoldsBurstsBack(const Parameters& p, const PathModel& path, const Streams& streams,
                            DataSize ref_wnd) {
  return p.extensions.capacity && streams.max_bitrate() < DataRate::Infinite() &&
         ref_wnd < BurstWindow(p, path, streams) && path.max_in_flight().lately() > ref_wnd;
}

}  // namespace lidar::scream
