// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs the sender, the link and the receiver, prints a line once per second, and writes the report.
#pragma once
#include "src/tools/bench/demo/run_options.h"

namespace lidar::demo {

/// Runs the demo and returns the exit code of the program: 1 if something failed or a guarantee did
/// not hold, 3 if the stream was poor, and otherwise 0. Throws std::runtime_error with a text for
/// the user.
int RunDemo(const RunOptions& options);

}  // namespace lidar::demo
