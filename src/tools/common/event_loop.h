// SPDX-License-Identifier: LGPL-2.1-or-later
// Waits for sockets, a precise timer and the signals that end a program.
#pragma once
#include <functional>
#include <map>

#include "src/base/time.h"
#include "src/tools/common/file_descriptor.h"

namespace lidar::tools {

/// CLOCK_MONOTONIC as a Time.
Time Now();
/// Returns the difference of Unix time from Now(), as of this call.
Duration UnixOffset();

class EventLoop {
 public:
  /// Blocks SIGINT and SIGTERM in this thread: Run returns on either. Throws std::runtime_error.
  EventLoop();

  void Watch(int fd, std::function<void()> readable);
  void Unwatch(int fd);
  /// Sets the latest time of the next call of `before_wait` by Run(); Time::max() for never.
  void SetWakeUp(Time when);
  /// Runs until a signal or Stop(): calls the handlers of readable descriptors, then `before_wait`,
  /// which may set the next wake-up.
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
