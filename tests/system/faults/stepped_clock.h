// SPDX-License-Identifier: LGPL-2.1-or-later
// Lets a test step the wall clock of the program that this file is linked into.
#pragma once

namespace lidar::test {

/// Steps the wall clock of this process: CLOCK_REALTIME, and the arrival times of datagrams that
/// the kernel reports, are `seconds` later from now on. Other clocks do not change.
void StepWallClock(int seconds);

}  // namespace lidar::test
