// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/scream/response/capacity_drop.h"

#include <algorithm>

namespace lidar::scream {

std::optional<DataSize> CapacityDrop::Update(Time now, const PathModel& path, const Load& load) {
  auto capacity = path.busy_run().capacity();
  if (!p_.extensions.capacity || !capacity) return std::nullopt;
  // The newest train counts more than a time in which the queue stood.
  if (const auto now_carried = path.train().rate()) capacity = std::max(*capacity, *now_carried);
  if (!path.Queueing(now, path.BusyQdelay(now, load.qdelay_target))) return std::nullopt;
  if (now - last_drop_ < std::min(p_.virtual_rtt, path.rtt().smoothed())) return std::nullopt;
  // Packets that arrive spaced as they left may show only our own rate beside others.
  if (path.L4sWorks(now) && path.busy_run().growth() < p_.drop_growth) return std::nullopt;
  const double part = Sure(now, path, load) ? p_.drop_threshold : p_.drop_threshold_unsure;
  if (*capacity * part > load.target_bitrate) return std::nullopt;
  const DataSize window = *capacity * path.rtt().min() * p_.target_rate_divisor;
  if (window > load.ref_wnd) return std::nullopt;
  last_drop_ = now;
  return window;
}

bool CapacityDrop::Sure(Time now, const PathModel& path, const Load& load) const {
  // While frames of another flow alternate with ours, the measurement shows only our share.
  if (path.busy_run().span() < std::min(load.frame_period, p_.virtual_rtt)) return false;
  // A few marks may be those of a well used link.
  if (path.L4sWorks(now) && 2 * path.busy_run().marked() < path.busy_run().packets()) return false;
  // The last reaction may be enough.
  return now - load.last_reaction >= std::min(p_.virtual_rtt, path.rtt().smoothed());
}

}  // namespace lidar::scream
