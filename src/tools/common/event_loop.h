// SPDX-License-Identifier: LGPL-2.1-or-later
// Waits for sockets, for a precise timer, and for the signals that end a program.
#pragma once
#include <functional>
#include <map>

#include "src/base/time.h"
#include "src/tools/common/file_descriptor.h"

namespace lidar::tools {

/// Returns the time of CLOCK_MONOTONIC.
Time Now();
/// Returns the time that must be added to Now() to get Unix time, as measured during this call.
Duration UnixOffset();

class EventLoop {
 public:
  /// Blocks SIGINT and SIGTERM in this thread. Run() returns when one of these signals arrives.
  /// Throws std::runtime_error.
  EventLoop();

  void Watch(int fd, std::function<void()> readable);
  void Unwatch(int fd);
  /// Sets the time at which Run() calls `before_wait` at the latest. Time::max() means that there
  /// is no such time.
  void SetWakeUp(Time when);
  /// Runs until a signal arrives or Stop() is called. After each wait, calls the handlers of the
  /// readable descriptors and then `before_wait`, which may set the next wake-up.
  void Run(const std::function<void()>& before_wait);
  void Stop() { running_ = false; }

 private:
  FileDescriptor epoll_;
  FileDescriptor timer_;
  FileDescriptor signals_;
  std::map<int, std::function<void()>> handlers_;
  bool running_ = false;
};

/// Requests a real-time scheduler for this thread. Returns false if the system refuses.
bool RequestRealtimePriority();

}  // namespace lidar::tools
