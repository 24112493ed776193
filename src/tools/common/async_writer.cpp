// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/common/async_writer.h"

#include <unistd.h>

#include <cerrno>
#include <utility>

namespace lidar::tools {

AsyncWriter::AsyncWriter(int fd, std::size_t capacity)
    : fd_(fd), capacity_(capacity), thread_([this] { Run(); }) {}

AsyncWriter::~AsyncWriter() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

bool AsyncWriter::Write(std::string bytes) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (backlog_bytes_ + bytes.size() > capacity_) {
      ++dropped_;
      return false;
    }
    backlog_bytes_ += bytes.size();
    backlog_.push_back(std::move(bytes));
  }
  changed_.notify_one();
  return true;
}

std::uint64_t AsyncWriter::dropped() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return dropped_;
}

void AsyncWriter::Run() {
  std::unique_lock<std::mutex> lock(mutex_);
  bool open = true;
  while (true) {
    changed_.wait(lock, [this] { return stopping_ || !backlog_.empty(); });
    if (backlog_.empty()) return;
    const std::string bytes = std::move(backlog_.front());
    backlog_.pop_front();
    lock.unlock();
    // Drops the remaining bytes if the reader has gone.
    open = open && WriteAll(bytes);
    lock.lock();
    backlog_bytes_ -= bytes.size();
  }
}

bool AsyncWriter::WriteAll(const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = write(fd_, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

}  // namespace lidar::tools
