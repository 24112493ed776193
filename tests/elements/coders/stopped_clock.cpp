// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/elements/coders/stopped_clock.h"

#include <gtest/gtest.h>

#include <atomic>
#include <ctime>

namespace {
std::atomic<gint64> stopped_at{0};  // [us]; 0: the real time
}  // namespace

/// Replaces GLib's function in this program and in the plugins that it loads.
extern "C" __attribute__((visibility("default"))) gint64 g_get_monotonic_time() {
  if (stopped_at != 0) return ++stopped_at;
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return gint64{now.tv_sec} * G_USEC_PER_SEC + now.tv_nsec / 1'000;
}

namespace lidar::test {

StoppedClock::StoppedClock() { stopped_at = g_get_monotonic_time(); }
StoppedClock::~StoppedClock() { stopped_at = 0; }
void StoppedClock::Advance(gint64 us) { stopped_at += us; }

}  // namespace lidar::test
