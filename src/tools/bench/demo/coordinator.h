// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs sender, link and receiver, shows a line each second, writes the report.
#pragma once
#include "src/tools/bench/demo/run_options.h"

namespace lidar::demo {

/// Returns the program's exit code: 1 if something failed or a guarantee broke, 3 for a poor
/// stream, else 0. Throws std::runtime_error with a text for the user.
int RunDemo(const RunOptions& options);

}  // namespace lidar::demo
