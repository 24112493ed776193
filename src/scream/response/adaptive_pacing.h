// SPDX-License-Identifier: LGPL-2.1-or-later
// Extension capacity: the pace of frames, and of a backlog in the sender's queue.
#pragma once
#include <algorithm>

#include "src/scream/model/path_model.h"
#include "src/scream/parameters.h"

namespace lidar::scream {

/// Returns the reserve: the time from the end of a frame's sending to the end of its period. If
/// marks work, a frame may cause a queue, as long as the packets in it stay unmarked.
inline Duration PacingReserve(const Parameters& p, const PathModel& path, Time now) {
  if (!path.L4sWorks(now)) return p.pacing_reserve;
  return std::clamp(FromSeconds(Seconds(path.marking_onset()) * p.onset_reserve),
                    p.shortest_pacing_reserve, p.pacing_reserve);
}

/// Returns PACKET_PACING_HEADROOM or, with the extension, the headroom at which the sending of a
/// frame ends `reserve` before its period ends. On a full link, each frame causes a queue as long
/// as `reserve`, which then drains.
inline double PacingHeadroom(const Parameters& p, Duration frame_period, Duration reserve) {
  if (!p.extensions.capacity) return p.packet_pacing_headroom;
  const double longest = std::min(1.0, Seconds(frame_period) / Seconds(p.long_frame_period));
  return 1 / (1 - std::clamp(Seconds(reserve) / Seconds(frame_period),
                             longest * p.min_pacing_reserve, p.max_pacing_reserve));
}

/// Returns the limit of the pace near the streams' maximum. The limit is below the measured
/// capacity, because otherwise the start of each frame would be marked.
inline DataRate RelaxedPace(const Parameters& p, const PathModel& path) {
  constexpr double kUnmarked = 0.9;
  const DataRate known = path.measured_capacity();
  if (!p.extensions.capacity || known <= DataRate()) return DataRate::Infinite();
  return known * kUnmarked;
}

/// Returns the pace at which a backlog is sent. It is the window's own rate, which exceeds the
/// lowered target, limited by the acknowledged rate or the measured capacity. After a drop of the
/// capacity, the last round trips were measured with a queue that has drained since. The time that
/// the link takes for the bytes in flight is then used instead.
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
