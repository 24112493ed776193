// SPDX-License-Identifier: LGPL-2.1-or-later
// Extension company: beside other flows the window grows and gives way as theirs do.
#pragma once
#include <algorithm>
#include <cmath>

#include "src/scream/model/path_model.h"
#include "src/scream/parameters.h"
#include "src/scream/response/reference_window.h"

namespace lidar::scream {

/// 1 where marking begins as late as a ramp's or without a sign of it, 0 where it begins so early
/// that each packet of queue is marked.
inline double LateMarking(Duration onset) {
  constexpr Duration kEarly = 1250us, kLate = 2ms;
  return std::clamp(Seconds(onset - kEarly) / Seconds(kLate - kEarly), 0.0, 1.0);
}

/// 1 where marking begins so early that a bolder window adds no delay to speak of. Marks without a
/// queue are a classic flow's (RFC 9332, section 2.1): the draft is bold enough beside it.
inline double EarlyMarking(Duration onset) {
  constexpr Duration kCoupled = 700us, kOwn = 900us;
  const double own = std::clamp(Seconds(onset - kCoupled) / Seconds(kOwn - kCoupled), 0.0, 1.0);
  return std::min(own, 1 - LateMarking(onset));
}

/// Packets that leave unevenly show what others send, and make as much more queue.
inline Duration PacingRipple(const Parameters& p, const PathModel& path) {
  if (!p.extensions.company) return Duration{0};
  return FromSeconds(Seconds(p.pacing_ripple) * LateMarking(path.marking_onset()));
}

/// From -1, clearly less than half of the link, to 1, clearly more.
inline double AboveHalf(DataRate own, DataRate link) {
  // Less than one half: two of ours with half each lean to gentle, and a flow that leaves in bursts
  // makes the link look faster than it is.
  constexpr double kHalf = 0.46;
  constexpr double kClearly = 0.03;
  return std::clamp((own / link - kHalf) / kClearly, -1.0, 1.0);
}

/// Beside others nobody needs more than half of the link. Who has less, or does not know, is about
/// as bold as Prague or Cubic; who has more gives way like the gentlest. So it takes no knowledge
/// of what the others are, or how many.
inline Boldness BesideOthers(const Parameters& p, const PathModel& path, Time now) {
  constexpr double kGrowthOfLess = 1.3;  // more than Prague's, as whole scans leave pauses
  constexpr double kGrowthOfMore = 1.0 / 3;
  /// The draft's alpha is above ours for as many marks, as it attacks faster than it decays.
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
  // A queue that others fill is no reason to hold packets back.
  b.pace = 1 + (p.target_rate_divisor - 1) * below;
  b.backoff = kGentlest * std::pow(p.prague_backoff / kGentlest, below);
  if (l4s)
    b.growth *= std::pow(above < 0 ? kGrowthOfLess : kGrowthOfMore, std::abs(above));
  else
    b.growth *= std::pow(p.classic_growth / b.growth, below);
  return b;
}

}  // namespace lidar::scream
