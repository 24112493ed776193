// SPDX-License-Identifier: LGPL-2.1-or-later
// Reports what a program throws: as a message, and by the exit code 1.
#pragma once
#include <cstdio>
#include <exception>

namespace lidar::tools {

/// The exit code of `run`; what it throws becomes a message.
template <class Run>
int Guard(const char* program, Run run) {
  try {
    return run();
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s: %s\n", program, e.what());
    return 1;
  }
}

}  // namespace lidar::tools
