// SPDX-License-Identifier: LGPL-2.1-or-later
// Bounds the end of a program when a server, disk or client hangs.
#pragma once
#include <errno.h>
#include <sys/time.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstring>

namespace lidar::tools {

/// Begins when the program ends: after `most` the process ends with a message and code 0. The exit
/// itself is not bounded, because a sanitizer's leak check takes long on a busy machine.
class BoundedEnd {
 public:
  explicit BoundedEnd(std::chrono::milliseconds most) {
    std::signal(SIGALRM, [](int) {
      constexpr char kText[] = ": not all has ended in time; ending all the same\n";
      const char* const name = program_invocation_short_name;
      [[maybe_unused]] auto written = write(STDERR_FILENO, name, std::strlen(name));
      written = write(STDERR_FILENO, kText, sizeof kText - 1);
      _exit(0);
    });
    SetAlarm(most);
  }
  ~BoundedEnd() { SetAlarm({}); }
  BoundedEnd(const BoundedEnd&) = delete;
  BoundedEnd& operator=(const BoundedEnd&) = delete;

 private:
  static void SetAlarm(std::chrono::microseconds in) {
    itimerval timer{};
    timer.it_value.tv_sec = in.count() / 1'000'000;
    timer.it_value.tv_usec = in.count() % 1'000'000;
    setitimer(ITIMER_REAL, &timer, nullptr);
  }
};

}  // namespace lidar::tools
