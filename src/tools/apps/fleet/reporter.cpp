// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/apps/fleet/reporter.h"

#include <cstdio>

#include "src/tools/common/printable.h"

namespace lidar::fleet {
namespace {

constexpr std::chrono::milliseconds kPoll{100};  // interval between checks of the connection

}  // namespace

Reporter::Reporter(const nats::ConnectionSettings& settings)
    : settings_(settings),
      refusals_(std::chrono::seconds(1), std::chrono::seconds(16)),
      thread_([this] { Run(); }) {}

Reporter::~Reporter() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
    wake_.notify_all();
  }
  thread_.join();
}

void Reporter::Publish(Reports reports) {
  const std::lock_guard lock(mutex_);
  waiting_ = std::move(reports);
  wake_.notify_all();
}

void Reporter::Open(Clock::time_point now) {
  open_at_ = now + refusals_.Next();
  connection_.reset();
  std::string why;
  connection_ = nats::Connection::Open(settings_, nullptr, &why);
  if (!connection_) Tell(why);
}

/// Prints `why` unless it is the same as the last time.
void Reporter::Tell(const std::string& why) {
  if (std::exchange(told_, why) == why) return;
  std::fprintf(stderr, "Statistics are not sent to NATS: %s\n", tools::Printable(why).c_str());
}

/// Returns true if there is a connection. libnats closes a connection that the server refuses, so
/// this function opens a new one after a pause.
bool Reporter::Connected(Clock::time_point now) {
  const auto current = [this] {
    return connection_ ? connection_->state() : nats::ConnectionState();
  };
  nats::ConnectionState state = current();
  if (state.refused()) Tell("the server refused the connection: " + state.last_error);
  if ((!connection_ || state.closed) && now >= open_at_) {
    Open(now);
    state = current();
  }
  if (!state.connected()) return false;
  refusals_.Reset();
  open_at_ = now + refusals_.Next();
  told_.clear();
  return true;
}

void Reporter::Send(const Reports& reports) const {
  for (const auto& [subject, text] : reports)
    natsConnection_Publish(connection_->get(), subject.c_str(), text.data(),
                           static_cast<int>(text.size()));
}

void Reporter::Run() {
  std::unique_lock lock(mutex_);
  while (!ending_) {
    lock.unlock();
    const bool connected = Connected(Clock::now());
    lock.lock();
    if (connected && !waiting_.empty()) {
      const Reports reports = std::exchange(waiting_, {});
      lock.unlock();
      Send(reports);
      lock.lock();
    }
    wake_.wait_for(lock, kPoll, [&] { return ending_ || (connected && !waiting_.empty()); });
  }
  lock.unlock();
  connection_.reset();
  nats_ReleaseThreadMemory();
}

}  // namespace lidar::fleet
