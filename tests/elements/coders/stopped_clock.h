// SPDX-License-Identifier: LGPL-2.1-or-later
// Stops GLib's monotonic clock for the coders, whose references end 2 s after the last report.
#pragma once
#include <glib.h>

namespace lidar::test {

/// While this object lives, a microsecond passes with each read of the clock. For tests without
/// threads: a wait with a time limit would end at once.
class StoppedClock {
 public:
  StoppedClock();
  ~StoppedClock();
  StoppedClock(const StoppedClock&) = delete;
  StoppedClock& operator=(const StoppedClock&) = delete;

  void Advance(gint64 us);
};

}  // namespace lidar::test
