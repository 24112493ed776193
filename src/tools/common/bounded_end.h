// SPDX-License-Identifier: LGPL-2.1-or-later
// Bounds the end of a program when a server, disk or client hangs.
#pragma once
#include <errno.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstring>

namespace lidar::tools {

/// Make an instance when the program begins to end. After `most`, it exits the process with a
/// message and code 0. Time in which the machine does not run the process does not count. The time
/// after the destructor is not bounded, because the leak check of a sanitizer takes long on a busy
/// machine.
class BoundedEnd {
 public:
  explicit BoundedEnd(std::chrono::milliseconds most) {
    ticks_left_ = kTicks;
    std::signal(SIGALRM, [](int) {
      if (--ticks_left_ > 0) return;
      constexpr char kText[] = ": did not end in time; exiting anyway\n";
      const char* const name = program_invocation_short_name;
      [[maybe_unused]] auto written = write(STDERR_FILENO, name, std::strlen(name));
      written = write(STDERR_FILENO, kText, sizeof kText - 1);
      _exit(0);
    });
    SetTimer(most / kTicks);
  }
  ~BoundedEnd() { SetTimer({}); }
  BoundedEnd(const BoundedEnd&) = delete;
  BoundedEnd& operator=(const BoundedEnd&) = delete;

 private:
  // The number of timer signals until the process exits. The kernel merges the signals that a
  // process missed into a single one, so that time in which the process did not run hardly counts.
  static constexpr int kTicks = 20;

  static void SetTimer(std::chrono::microseconds tick) {
    itimerval timer{};
    timer.it_value.tv_sec = tick.count() / 1'000'000;
    timer.it_value.tv_usec = tick.count() % 1'000'000;
    timer.it_interval = timer.it_value;
    setitimer(ITIMER_REAL, &timer, nullptr);
  }

  static inline std::atomic<int> ticks_left_{0};
};

}  // namespace lidar::tools
