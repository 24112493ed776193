// SPDX-License-Identifier: LGPL-2.1-or-later
// A line on standard error that shows how far long work is.
#pragma once
#include <functional>
#include <string>

namespace lidar::tools {

/// Draws only where standard error is a terminal.
std::function<void(double)> ProgressBar(const std::string& what);

}  // namespace lidar::tools
