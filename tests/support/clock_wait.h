// SPDX-License-Identifier: LGPL-2.1-or-later
// Functions with which a test waits until an element waits for the test clock of its harness.
#pragma once
#include <gst/check/gstharness.h>
#include <gst/check/gsttestclock.h>

#include "tests/support/patience.h"

namespace lidar::test {

/// The time of the test clock at running time 0. It is not 0, because a test could not distinguish
/// clock time and running time otherwise.
inline constexpr GstClockTime kClockStart = 7 * GST_SECOND;

/// Gives the harness a test clock. Must be called before the harness plays.
inline void UseTestClock(GstHarness* h) {
  gst_harness_use_testclock(h);
  gst_harness_set_time(h, kClockStart);
  gst_element_set_base_time(h->element, kClockStart);
}

/// Waits until the element waits for `time` on the test clock, and returns true. Returns false
/// after kPatience.
inline bool AwaitClockWait(GstHarness* h, GstClockTime time) {
  auto* clock = GST_TEST_CLOCK(GST_ELEMENT_CLOCK(h->element));
  return Eventually([&] { return gst_test_clock_get_next_entry_time(clock) == time; });
}

}  // namespace lidar::test
