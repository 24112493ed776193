// SPDX-License-Identifier: LGPL-2.1-or-later
// An end of a stream in another process, so that its clock, CPU time and memory are its own.
#pragma once
#include <gio/gio.h>

#include <chrono>
#include <cstdint>
#include <string>

namespace lidar::test {

struct ChildReport {
  std::uint64_t sent = 0, received = 0, lost = 0, bad = 0, clouds = 0, feedback = 0;
  std::uint64_t dropped_by_kernel = 0;
  std::int64_t wall_clock = 0;  // [us]
};

/// The program fault-end, which the environment variable FAULT_END names.
class ChildEnd {
 public:
  /// `role` is "send" or "receive"; `options` are those of screamsink or screamsrc.
  ChildEnd(const char* role, std::uint16_t port, const std::string& options = "");
  ~ChildEnd();
  ChildEnd(const ChildEnd&) = delete;
  ChildEnd& operator=(const ChildEnd&) = delete;

  ChildReport Report() { return Ask("report"); }
  /// Sets the process's wall clock forward, or back.
  void StepClock(int seconds) { Ask("step " + std::to_string(seconds)); }
  /// Ends a sender with EOS.
  ChildReport Finish() { return Ask("finish"); }
  /// Time until a receiver has shown another cloud; max() if that takes longer than `limit`.
  std::chrono::milliseconds NextCloud(std::chrono::milliseconds limit);
  std::chrono::milliseconds CpuTime() const;
  /// Most resident memory so far [bytes].
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
