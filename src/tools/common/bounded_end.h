// SPDX-License-Identifier: LGPL-2.1-or-later
// Bounds the end of a program, if a server, disk or client hangs.
#pragma once
#include <errno.h>
#include <unistd.h>

#include <csignal>
#include <cstring>

namespace lidar::tools {

/// The end of the program begins with this object: after `seconds` the process ends with a message
/// and with 0. The exit of the process itself is not bounded: a sanitizer looks for leaks there,
/// which takes long on a busy machine.
class BoundedEnd {
 public:
  explicit BoundedEnd(unsigned seconds) {
    std::signal(SIGALRM, [](int) {
      constexpr char kText[] = ": not all has ended in time; ending all the same\n";
      const char* const name = program_invocation_short_name;
      [[maybe_unused]] auto written = write(STDERR_FILENO, name, std::strlen(name));
      written = write(STDERR_FILENO, kText, sizeof kText - 1);
      _exit(0);
    });
    alarm(seconds);
  }
  ~BoundedEnd() { alarm(0); }
  BoundedEnd(const BoundedEnd&) = delete;
  BoundedEnd& operator=(const BoundedEnd&) = delete;
};

}  // namespace lidar::tools
