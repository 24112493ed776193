// SPDX-License-Identifier: LGPL-2.1-or-later
// Waits of an element for the test clock of its harness.
#pragma once
#include <gst/check/gstharness.h>
#include <gst/check/gsttestclock.h>

#include "tests/support/patience.h"

namespace lidar::test {

/// Returns true once the element waits for `time` on the test clock, and false after kPatience.
inline bool AwaitClockWait(GstHarness* h, GstClockTime time) {
  auto* clock = GST_TEST_CLOCK(GST_ELEMENT_CLOCK(h->element));
  return Eventually([&] { return gst_test_clock_get_next_entry_time(clock) == time; });
}

}  // namespace lidar::test
