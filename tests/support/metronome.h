// SPDX-License-Identifier: LGPL-2.1-or-later
// Measures how long something takes on a machine that may not let the program run.
#pragma once
#include <atomic>
#include <chrono>
#include <thread>

namespace lidar::test {

/// Time as the steps of a thread that sleeps: while the machine lets the program wait, this thread
/// makes no step either.
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
