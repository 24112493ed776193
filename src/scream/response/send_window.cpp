// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/scream/response/send_window.h"

#include <algorithm>

namespace lidar::scream {

DataSize SendWindow::Max(Time now, DataSize ref_wnd, const PathModel& path,
                         Duration qdelay_target) const {
  double overhead = p_.ref_wnd_overhead_min + (p_.ref_wnd_overhead_max - p_.ref_wnd_overhead_min) *
                                                  path.queue_delay().ref_wnd_delay_scale();
  if (p_.extensions.capacity) {
    if (path.L4sWorks(now)) overhead = std::min(overhead, p_.open_overhead);
    if (path.Queueing(now, 2 * path.BusyQdelay(now, qdelay_target))) overhead = p_.bounded_overhead;
    overhead *= 1 + Seconds(path.UnreportedTime()) / Seconds(path.rtt().smoothed());
  }
  return ref_wnd * overhead;
}

Time SendWindow::Opens(DataSize size, DataSize in_flight, DataSize max) const {
  const bool fits = in_flight.bytes() == 0 || in_flight + size <= max;
  return fits ? Time{} : last_sent_ + size / p_.rate_pace_min;
}

}  // namespace lidar::scream
