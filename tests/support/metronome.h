// SPDX-License-Identifier: LGPL-2.1-or-later
// Measures time in a way that does not count the time in which the machine does not run this
// program.
#pragma once
#include <atomic>
#include <chrono>
#include <thread>

namespace lidar::test {

/// Measures time as the number of steps of a thread that sleeps for a fixed time in each step.
/// While a busy machine does not run this process, the thread makes no steps.
class Metronome {
 public:
  Metronome()
      : thread_([this] {
          while (!stopping_) {
            std::this_thread::sleep_for(kStep);
            ++steps_;
          }
        }) {}
  ~Metronome() {
    stopping_ = true;
    thread_.join();
  }
  Metronome(const Metronome&) = delete;
  Metronome& operator=(const Metronome&) = delete;

  std::chrono::milliseconds elapsed() const { return steps_.load() * kStep; }

 private:
  static constexpr std::chrono::milliseconds kStep{10};
  std::atomic<bool> stopping_{false};
  std::atomic<int> steps_{0};
  std::thread thread_;
};

}  // namespace lidar::test
