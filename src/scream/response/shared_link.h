// SPDX-License-Identifier: LGPL-2.1-or-later
// The extension company: while other flows share the link, our window grows and shrinks as their
// windows do.
#pragma once
#include <algorithm>
#include <cmath>

#include "src/scream/model/path_model.h"
#include "src/scream/parameters.h"
#include "src/scream/response/reference_window.h"

namespace lidar::scream {

/// Returns 1 if the bottleneck starts to mark at a queue as long as an AQM with a ramp does, or if
/// this length is unknown. Returns 0 if it starts at so short a queue that each queued packet is
/// marked.
inline double LateMarking(Duration onset) {
  constexpr Duration kEarly = 1250us, kLate = 2ms;
  return std::clamp(Seconds(onset - kEarly) / Seconds(kLate - kEarly), 0.0, 1.0);
}

/// Returns 1 if the bottleneck starts to mark at so short a queue that a bolder window adds little
/// delay. Returns 0 if marks come without an L4S queue. The queue of a classic flow then causes the
/// marks by coupling (RFC 9332, section 2.1), and the draft's window is bold enough beside such a
/// flow.
inline double EarlyMarking(Duration onset) {
  constexpr Duration kCoupled = 700us, kOwn = 900us;
  const double own = std::clamp(Seconds(onset - kCoupled) / Seconds(kOwn - kCoupled), 0.0, 1.0);
  return std::min(own, 1 - LateMarking(onset));
}

/// Returns the time by which departures are made uneven. Uneven departures show the packets of
/// other flows, but add a queue of the same length.
inline Duration PacingRipple(const Parameters& p, const PathModel& path) {
  if (!p.extensions.company) return Duration{0};
  return FromSeconds(Seconds(p.pacing_ripple) * LateMarking(path.marking_onset()));
}

/// Returns a value from -1 (clearly less than half of the link) to 1 (clearly more).
inline double AboveHalf(DataRate own, DataRate link) {
  // The constant is below one half for two reasons: two of our flows with half of the link each
  // then both give way early, and the bursts of a flow make the link look faster than it is.
  constexpr double kHalf = 0.46;
  // If this ramp were a step, two of our flows would have a queue of 5.2 ms instead of 3.9 ms at
  // p99, and Jain's index beside Prague at 4 Mbit/s would be 0.946 instead of 0.955.
  constexpr double kClearly = 0.03;
  return std::clamp((own / link - kHalf) / kClearly, -1.0, 1.0);
}

/// Returns the boldness beside other flows. Half of the link is enough for us. A flow with less
/// than half, or with an unknown share, is about as bold as Prague or Cubic. A flow with more gives
/// way as early as a flow of the draft, which is the gentlest kind. The kind and the number of the
/// other flows therefore need not be known.
inline Boldness BesideOthers(const Parameters& p, const PathModel& path, Time now) {
  constexpr double kGrowthOfLess = 1.3;  // above Prague's growth, because whole scans leave pauses
  constexpr double kGrowthOfMore = 1.0 / 3;
  /// The backoff of a flow that has clearly more than half. It is as strong as the draft's backoff,
  /// although it is above 1: the draft's alpha rises faster than it falls, and is therefore higher
  /// than our alpha for the same marks.
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
  // Holding packets back would not shorten a queue that other flows fill.
  b.pace = 1 + (p.target_rate_divisor - 1) * below;
  b.backoff = kGentlest * std::pow(p.prague_backoff / kGentlest, below);
  if (l4s)
    b.growth *= std::pow(above < 0 ? kGrowthOfLess : kGrowthOfMore, std::abs(above));
  else
    b.growth *= std::pow(p.classic_growth / b.growth, below);
  return b;
}

}  // namespace lidar::scream
