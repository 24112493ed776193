// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/apps/edge/receiver.h"

#include "src/tools/common/event_loop.h"

namespace lidar::edge {
namespace {

constexpr std::chrono::milliseconds kPoll{100};

}  // namespace

Receiver::Receiver(const EdgeConfig& config, const RobotConfig& robot, GSocket* socket)
    : session_(config, robot, socket), thread_([this] { Run(); }) {}

Receiver::~Receiver() {
  AskToEnd();
  thread_.join();
}

void Receiver::AskToEnd() {
  const std::lock_guard lock(mutex_);
  ending_ = true;
  wake_.notify_all();
}

void Receiver::Run() {
  std::unique_lock lock(mutex_);
  while (!ending_) {
    lock.unlock();
    session_.Poll(tools::Now());
    lock.lock();
    wake_.wait_for(lock, kPoll, [this] { return ending_; });
  }
  lock.unlock();
  session_.Finish(tools::Now());
}

}  // namespace lidar::edge
