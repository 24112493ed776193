// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs an end of a stream in another process, so that the end has a clock, CPU time and memory of
// its own.
#pragma once
#include <gio/gio.h>

#include <chrono>
#include <cstdint>
#include <string>

namespace lidar::test {

struct ChildReport {
  std::uint64_t sent = 0, received = 0, lost = 0, bad = 0, clouds = 0, feedback = 0;
  std::uint64_t dropped_by_kernel = 0;
  // The wall clock of the process [us].
  std::int64_t wall_clock = 0;
};

/// A process that runs the program fault-end. The environment variable FAULT_END contains the path
/// of the program.
class ChildEnd {
 public:
  /// Starts the process. `role` is "send" or "receive". `options` are properties of its screamsink
  /// or screamsrc.
  ChildEnd(const char* role, std::uint16_t port, const std::string& options = "");
  ~ChildEnd();
  ChildEnd(const ChildEnd&) = delete;
  ChildEnd& operator=(const ChildEnd&) = delete;

  ChildReport Report() { return Ask("report"); }
  /// Sets the wall clock of the process forward by `seconds`, or back if `seconds` is negative.
  void StepClock(int seconds) { Ask("step " + std::to_string(seconds)); }
  /// Ends the stream of a sender with EOS.
  ChildReport Finish() { return Ask("finish"); }
  /// Waits until the receiver has decoded another cloud, and returns how long that took. Returns
  /// max() if it took longer than `limit`.
  std::chrono::milliseconds NextCloud(std::chrono::milliseconds limit);
  std::chrono::milliseconds CpuTime() const;
  /// Returns the largest resident memory that the process has had so far [bytes].
  std::uint64_t PeakMemory() const;
  /// Ends the process. Returns true if it ended without an error on its bus.
  bool Close();

 private:
  ChildReport Ask(const std::string& command);
  std::string Proc(const char* file) const;

  GSubprocess* process_ = nullptr;
  GDataInputStream* answers_ = nullptr;
};

}  // namespace lidar::test
