// SPDX-License-Identifier: LGPL-2.1-or-later
// The command "scream-bench rx", which receives frames and measures their age.
#pragma once
#include "src/tools/bench/scream_bench/options.h"

namespace lidar::tools {

/// Runs the receiver and returns the exit code of the program. Throws std::runtime_error with a
/// text for the user.
int RunReceiver(const BenchOptions& options);

}  // namespace lidar::tools
