// SPDX-License-Identifier: LGPL-2.1-or-later
// Writes to a pipe from a thread of its own, so that a slow reader never holds up a measurement.
#pragma once
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

namespace lidar::tools {

/// Queues writes for its own thread. A write that would let the queue exceed `capacity` bytes is
/// dropped as a whole and counted. Thread-safe.
class AsyncWriter {
 public:
  /// Does not take ownership of `fd`.
  AsyncWriter(int fd, std::size_t capacity);
  /// Writes the bytes that are still queued.
  ~AsyncWriter();
  AsyncWriter(const AsyncWriter&) = delete;
  AsyncWriter& operator=(const AsyncWriter&) = delete;

  bool Write(std::string bytes);
  std::uint64_t dropped() const;

 private:
  void Run();
  bool WriteAll(const std::string& bytes);

  const int fd_;
  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::string> backlog_;
  std::size_t backlog_bytes_ = 0;
  std::uint64_t dropped_ = 0;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace lidar::tools
