// SPDX-License-Identifier: LGPL-2.1-or-later
// Extension capacity: reduces the rate at once when the link carries much less.
#pragma once
#include <algorithm>
#include <optional>

#include "src/scream/model/path_model.h"
#include "src/scream/parameters.h"
#include "src/scream/response/reference_window.h"

namespace lidar::scream {

class CapacityDrop {
 public:
  explicit CapacityDrop(const Parameters& parameters) : p_(parameters) {}

  /// Call it after each report. Returns the window that fills the link if it carries much less than
  /// the target, at most once a round trip.
  std::optional<DataSize> Update(Time now, const PathModel& path, const ReferenceWindow& present,
                                 DataRate target_bitrate, Duration frame_period) {
    const auto capacity = path.busy_run().capacity();
    if (!p_.extensions.capacity || !capacity) return std::nullopt;
    if (!path.Queueing(path.BusyQdelay(now))) return std::nullopt;
    if (now - last_drop_ < path.ReactionInterval()) return std::nullopt;
    // Packets that arrive spaced as they left may show only our own rate beside others.
    if (path.L4sWorks(now) && path.busy_run().growth() < p_.drop_growth) return std::nullopt;
    const double part =
        Sure(now, path, present, frame_period) ? p_.drop_threshold : p_.drop_threshold_unsure;
    if (*capacity * part > target_bitrate) return std::nullopt;
    const DataSize window = *capacity * path.rtt().min() * p_.target_rate_divisor;
    if (window > present.ref_wnd()) return std::nullopt;
    last_drop_ = now;
    return window;
  }

 private:
  /// Returns true if the measurement is long enough and has no other explanation.
  bool Sure(Time now, const PathModel& path, const ReferenceWindow& present,
            Duration frame_period) const {
    // While frames of another flow alternate with ours, the measurement shows only our share.
    if (path.busy_run().span() < std::min(frame_period, p_.virtual_rtt)) return false;
    // A few marks may be those of a well used link.
    if (path.L4sWorks(now) && 2 * path.busy_run().marked() < path.busy_run().packets())
      return false;
    // The last reaction may be enough.
    return now - present.last_reaction_to_congestion_time() >= path.ReactionInterval();
  }

  const Parameters& p_;
  Time last_drop_{};
};

}  // namespace lidar::scream
