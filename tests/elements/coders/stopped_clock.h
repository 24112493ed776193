// SPDX-License-Identifier: LGPL-2.1-or-later
// Stops GLib's monotonic clock. Coders use this clock to give up their references 2 s after the
// last acknowledgement, and foxglovesink uses it to close connections and to forgive wrong tokens.
#pragma once
#include <glib.h>

namespace lidar::test {

/// While an object of this class exists, the clock advances only by a microsecond with each read.
/// The class is for tests without waits for `g_get_monotonic_time()` plus a limit, because such a
/// wait would end at once.
class StoppedClock {
 public:
  StoppedClock();
  ~StoppedClock();
  StoppedClock(const StoppedClock&) = delete;
  StoppedClock& operator=(const StoppedClock&) = delete;

  void Advance(gint64 us);
};

}  // namespace lidar::test
