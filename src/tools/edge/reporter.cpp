// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/edge/reporter.h"

#include <chrono>
#include <cstdio>

namespace lidar::edge {
namespace {

nats::ConnectionSettings ToConnection(const NatsConfig& nats) {
  nats::ConnectionSettings settings;
  settings.url = nats.url;
  settings.name = "lidar-edge";
  settings.credentials_file = nats.credentials_file;
  settings.tls_ca_file = nats.tls_ca_file;
  settings.tls_cert_file = nats.tls_cert_file;
  settings.tls_key_file = nats.tls_key_file;
  return settings;
}

}  // namespace

Reporter::Reporter(const EdgeConfig& config, std::function<Reports()> collect)
    : config_(config),
      collect_(std::move(collect)),
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

void Reporter::Open(Clock::time_point now) {
  open_at_ = now + refusals_.Next();
  connection_.reset();
  std::string why;
  connection_ = nats::Connection::Open(ToConnection(config_.nats), nullptr, &why);
  if (connection_ || why == told_) return;
  told_ = why;
  std::fprintf(stderr, "NATS gets no statistics: %s\n", why.c_str());
}

/// A connection that the server refused is no more, so there is another one after a while.
bool Reporter::Connected(Clock::time_point now) {
  if ((!connection_ || connection_->state().closed) && now >= open_at_) Open(now);
  const bool connected = connection_ && connection_->state().connected();
  if (connected) refusals_.Reset();
  return connected;
}

void Reporter::Run() {
  const auto interval = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(config_.interval_s));
  std::unique_lock lock(mutex_);
  while (!ending_) {
    lock.unlock();
    if (Connected(Clock::now()))
      for (const auto& [subject, text] : collect_())
        natsConnection_Publish(connection_->get(), subject.c_str(), text.data(),
                               static_cast<int>(text.size()));
    lock.lock();
    wake_.wait_for(lock, interval, [this] { return ending_; });
  }
  lock.unlock();
  connection_.reset();
  nats_ReleaseThreadMemory();
}

}  // namespace lidar::edge
