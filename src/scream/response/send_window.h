// SPDX-License-Identifier: LGPL-2.1-or-later
// The draft's send window, and how the extension `capacity` changes it.
#pragma once
#include <algorithm>

#include "src/scream/model/path_model.h"
#include "src/scream/parameters.h"

namespace lidar::scream {

class SendWindow {
 public:
  explicit SendWindow(const Parameters& parameters) : p_(parameters) {}

  void OnSent(Time now) { last_sent_ = now; }
  /// Returns the limit of bytes in flight. With the extension capacity, the limit is a little above
  /// the window on an L4S path, and equal to the window while a queue lasts. Bytes that have
  /// arrived but are not reported yet are added to the limit.
  DataSize Max(Time now, DataSize ref_wnd, const PathModel& path) const {
    const double range = p_.ref_wnd_overhead_max - p_.ref_wnd_overhead_min;
    double overhead = p_.ref_wnd_overhead_min + range * path.queue_delay().ref_wnd_delay_scale();
    if (p_.extensions.capacity) {
      if (path.L4sWorks(now)) overhead = std::min(overhead, p_.open_overhead);
      if (path.Queueing(2 * path.BusyQdelay(now))) overhead = p_.bounded_overhead;
      overhead *= 1 + Seconds(path.UnreportedTime()) / Seconds(path.rtt().smoothed());
    }
    return std::max(ref_wnd * overhead, 2 * p_.mss);
  }
  /// Returns the time from which on a packet of `size` may be sent. If the window is closed,
  /// packets are still sent at RATE_PACE_MIN, so that the loss of feedback cannot stop the sender.
  Time Opens(DataSize size, DataSize in_flight, DataSize max) const {
    const bool fits = in_flight.bytes() == 0 || in_flight + size <= max;
    return fits ? Time{} : last_sent_ + size / p_.rate_pace_min;
  }

 private:
  const Parameters& p_;
  Time last_sent_{};
};

}  // namespace lidar::scream
