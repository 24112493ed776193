// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/demo/stream_comparer.h"

#include <chrono>

namespace lidar::demo {
namespace {

/// The longest time that a received slice waits for the sent one. The received slice may come
/// first, because the sender's process may still be writing the sent one.
constexpr auto kOriginalTimeout = std::chrono::seconds{2};

}  // namespace

StreamComparer::StreamComparer(int sent_fd, int received_fd, double reach_m)
    : sent_fd_(sent_fd),
      received_fd_(received_fd),
      reach_m_(reach_m),
      sent_thread_([this] { ReadSent(); }),
      received_thread_([this] { ReadReceived(); }) {}

StreamComparer::~StreamComparer() { Finish(); }

void StreamComparer::Finish() {
  if (sent_thread_.joinable()) sent_thread_.join();
  if (received_thread_.joinable()) received_thread_.join();
}

std::vector<StreamComparer::Result> StreamComparer::Take() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(results_, {});
}

void StreamComparer::ReadSent() {
  while (auto cloud = ReadFrame(sent_fd_)) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const SliceKey key = cloud->key;
    pending_.insert_or_assign(key, *std::move(cloud));
    if (pending_.size() > kMaxPending) pending_.erase(pending_.begin());
    arrived_.notify_one();
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  sent_ended_ = true;
  arrived_.notify_one();
}

bool StreamComparer::TakeSent(SliceKey key, Cloud* cloud) {
  std::unique_lock<std::mutex> lock(mutex_);
  arrived_.wait_for(lock, kOriginalTimeout, [&] { return pending_.count(key) > 0 || sent_ended_; });
  const auto found = pending_.find(key);
  if (found == pending_.end()) return false;
  *cloud = std::move(found->second);
  pending_.erase(found);
  return true;
}

void StreamComparer::ReadReceived() {
  while (const auto received = ReadFrame(received_fd_)) {
    Cloud sent;
    if (!TakeSent(received->key, &sent)) continue;
    const Comparison comparison = Compare(sent, *received, reach_m_);
    const std::lock_guard<std::mutex> lock(mutex_);
    results_.emplace_back(received->key, comparison);
  }
}

}  // namespace lidar::demo
