// SPDX-License-Identifier: LGPL-2.1-or-later
// The extension `company`: while others share the link, the window grows and shrinks as theirs do.
#pragma once
#include <algorithm>
#include <cmath>

#include "src/scream/model/path_model.h"
#include "src/scream/parameters.h"
#include "src/scream/response/reference_window.h"

namespace lidar::scream {

/// Returns 1 if marking starts at a queue as long as a ramp's, or if the start is unknown. Returns
/// 0 if marking starts at so short a queue that each queued packet is marked.
inline double LateMarking(Duration onset) {
  constexpr Duration kEarly = 1250us, kLate = 2ms;
  return std::clamp(Seconds(onset - kEarly) / Seconds(kLate - kEarly), 0.0, 1.0);
}

/// Returns 1 if marking starts so early that a bolder window adds little delay. It returns 0 if
/// marks come without an L4S queue: the queue of a classic flow causes them, by coupling (RFC 9332,
/// section 2.1), and the draft's window is bold enough beside that flow.
inline double EarlyMarking(Duration onset) {
  constexpr Duration kCoupled = 700us, kOwn = 900us;
  const double own = std::clamp(Seconds(onset - kCoupled) / Seconds(kOwn - kCoupled), 0.0, 1.0);
  return std::min(own, 1 - LateMarking(onset));
}

/// Returns by how much departures are made uneven. The unevenness shows other flows' packets, and
/// adds a queue of the same length.
inline Duration PacingRipple(const Parameters& p, const PathModel& path) {
  if (!p.extensions.company) return Duration{0};
  return FromSeconds(Seconds(p.pacing_ripple) * LateMarking(path.marking_onset()));
}

/// Returns a value from -1 (clearly less than half of the link) to 1 (clearly more).
inline double AboveHalf(DataRate own, DataRate link) {
  // The constant is below one half, so that two of our flows with half each both give way early,
  // and because a flow's bursts make the link look faster than it is.
  constexpr double kHalf = 0.46;
  // If this ramp were a step, two of our flows would have a queue of 5.2 ms instead of 3.9 ms at
  // p99, and Jain's index beside Prague at 4 Mbit/s would be 0.946 instead of 0.955.
  constexpr double kClearly = 0.03;
  return std::clamp((own / link - kHalf) / kClearly, -1.0, 1.0);
}

/// Half of the link is enough beside other flows. A flow with less, or with an unknown share, is
/// about as bold as Prague or Cubic. A flow with more gives way as early as a flow of the draft,
/// the gentlest kind. So the kind and the number of the other flows need not be known.
inline Boldness BesideOthers(const Parameters& p, const PathModel& path, Time now) {
  constexpr double kGrowthOfLess = 1.3;  // above Prague's, as whole scans leave pauses
  constexpr double kGrowthOfMore = 1.0 / 3;
  /// Backoff of a flow that has clearly more than half, as strong as the draft's. It is above 1,
  /// because the draft's alpha, which rises faster than it falls, exceeds ours for the same marks.
  constexpr double kGentlest = 2.5;
  Boldness b;
  if (!p.extensions.company) return b;
  const bool l4s = path.L4sWorks(now);
  const double early = l4s ? EarlyMarking(path.marking_onset()) : 0;
  b.growth += (p.early_growth - b.growth) * early;
  b.backoff += (p.prague_backoff - b.backoff) * early;
  const CrossTraffic& others = path.cross_traffic();
  if (!others.found() && !(l4s && others.unseen())) return b;
  const auto link = others.link_rate();
  const double above = link ? AboveHalf(path.long_acked_rate(now), *link) : -1;
  const double below = (1 - above) / 2;  // 1: clearly less than half
  // Packets need not be held back for a queue that others fill.
  b.pace = 1 + (p.target_rate_divisor - 1) * below;
  b.backoff = kGentlest * std::pow(p.prague_backoff / kGentlest, below);
  if (l4s)
    b.growth *= std::pow(above < 0 ? kGrowthOfLess : kGrowthOfMore, std::abs(above));
  else
    b.growth *= std::pow(p.classic_growth / b.growth, below);
  return b;
}

}  // namespace lidar::scream
