// SPDX-License-Identifier: LGPL-2.1-or-later
// Extension capacity: reduces the rate at once when the link carries much less.
#pragma once
#include <algorithm>
#include <optional>

#include "src/scream/model/path_model.h"
#include "src/scream/parameters.h"
#include "src/scream/response/reference_window.h"

namespace lidar::scream {

/// Returns true if the measurement is long enough and nothing else can explain it.
inline bool SureOfDrop(Time now, const Parameters& p, const PathModel& path,
                       const ReferenceWindow& present, Duration frame_period) {
  // While frames of another flow alternate with ours, the measurement shows only our share.
  if (path.busy_run().span() < std::min(frame_period, p.virtual_rtt)) return false;
  // A link that is well used marks a few packets, too.
  if (path.L4sWorks(now) && 2 * path.busy_run().marked() < path.busy_run().packets()) return false;
  // The last reaction may be enough, so that another one must wait.
  return now - present.last_reaction_to_congestion_time() >= path.ReactionInterval();
}

/// Returns the window that fills the link if the link carries much less than the target. Does so at
/// most once per reaction interval.
inline std::optional<DataSize> WindowAfterDrop(Time now, const Parameters& p, const PathModel& path,
                                               const ReferenceWindow& present,
                                               DataRate target_bitrate, Duration frame_period) {
  const auto capacity = path.busy_run().capacity();
  if (!p.extensions.capacity || !capacity) return std::nullopt;
  if (!path.Queueing(path.BusyQdelay(now))) return std::nullopt;
  if (now - present.last_drop_time() < path.ReactionInterval()) return std::nullopt;
  // If packets arrive with the spacing with which they left, they may show only our own rate beside
  // other flows.
  if (path.L4sWorks(now) && path.busy_run().growth() < p.drop_growth) return std::nullopt;
  const bool sure = SureOfDrop(now, p, path, present, frame_period);
  if (*capacity * (sure ? p.drop_threshold : p.drop_threshold_unsure) > target_bitrate)
    return std::nullopt;
  const DataSize window = *capacity * path.rtt().min() * p.target_rate_divisor;
  if (window > present.ref_wnd()) return std::nullopt;
  return window;
}

}  // namespace lidar::scream
