// SPDX-License-Identifier: LGPL-2.1-or-later
// Programs that end whatever servers, disks and clients do.
#pragma once
#include <errno.h>
#include <unistd.h>

#include <csignal>
#include <cstring>

namespace lidar::tools {

/// To be called when the end begins: after `seconds` the process is gone, with a word and with 0.
inline void BoundTheEnd(unsigned seconds) {
  std::signal(SIGALRM, [](int) {
    constexpr char kText[] = ": not all has ended in time; ending all the same\n";
    const char* const name = program_invocation_short_name;
    [[maybe_unused]] auto written = write(STDERR_FILENO, name, std::strlen(name));
    written = write(STDERR_FILENO, kText, sizeof kText - 1);
    _exit(0);
  });
  alarm(seconds);
}

}  // namespace lidar::tools
