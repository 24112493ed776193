// SPDX-License-Identifier: LGPL-2.1-or-later
// Extension shared_link: beside other flows the window grows and gives way as theirs do.
#pragma once
#include <algorithm>

#include "src/scream/model/path_model.h"
#include "src/scream/parameters.h"
#include "src/scream/response/reference_window.h"

namespace lidar::scream {

/// 1 where marking begins so early that a bolder window adds no delay to speak of. Marks without a
/// queue are a classic flow's (RFC 9332, section 2.1): the draft is bold enough beside it.
inline double EarlyMarking(Duration onset) {
  constexpr Duration kCoupled = 700us, kOwn = 900us, kEarly = 1250us, kLate = 2ms;
  if (onset < kOwn)
    return std::clamp(Seconds(onset - kCoupled) / Seconds(kOwn - kCoupled), 0.0, 1.0);
  return std::clamp(Seconds(kLate - onset) / Seconds(kLate - kEarly), 0.0, 1.0);
}

inline Boldness BesideOthers(const Parameters& p, const PathModel& path, Time now) {
  Boldness b;
  if (!p.extensions.shared_link) return b;
  const bool shared = path.cross_traffic().found();
  if (!path.L4sWorks(now)) {
    if (shared) b.growth = p.classic_growth;
    return b;
  }
  const double early = EarlyMarking(path.marking_onset());
  b.growth += (p.early_growth - b.growth) * early;
  b.backoff += (p.prague_backoff - b.backoff) * (shared ? 1 : early);
  return b;
}

}  // namespace lidar::scream
