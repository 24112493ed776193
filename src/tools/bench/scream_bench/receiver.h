// SPDX-License-Identifier: LGPL-2.1-or-later
// scream-bench rx.
#pragma once
#include "src/tools/bench/scream_bench/options.h"

namespace lidar::tools {

/// Returns the program's exit code. Throws std::runtime_error with a text for the user.
int RunReceiver(const BenchOptions& options);

}  // namespace lidar::tools
