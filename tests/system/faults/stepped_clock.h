// SPDX-License-Identifier: LGPL-2.1-or-later
// A wall clock that a test can set, for the program that it is linked into.
#pragma once

namespace lidar::test {

/// From now on CLOCK_REALTIME, and the time at which the kernel says that datagrams arrived, are
/// `seconds` later, as if somebody had set the clock of the machine. Other clocks do not change.
void StepWallClock(int seconds);

}  // namespace lidar::test
