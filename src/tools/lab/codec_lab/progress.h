// SPDX-License-Identifier: LGPL-2.1-or-later
// Shows the progress of long work on standard error.
#pragma once
#include <unistd.h>

#include <cstdio>
#include <functional>
#include <string>

namespace lidar::tools {

/// Returns a function that shows which share of the work is done, from 0 to 1. It shows nothing
/// unless standard error is a terminal.
inline std::function<void(double)> ProgressBar(const std::string& what) {
  if (isatty(STDERR_FILENO) == 0) return [](double) {};
  return [what, shown = -1](double done) mutable {
    const int percent = static_cast<int>(100 * done);
    if (percent == shown) return;
    shown = percent;
    std::fprintf(stderr, "\r%s %3d %%%s", what.c_str(), percent, percent >= 100 ? "\r\n" : "");
    std::fflush(stderr);
  };
}

}  // namespace lidar::tools
