// SPDX-License-Identifier: LGPL-2.1-or-later
// Publishes reports about robots on NATS. Has a thread and a connection of its own.
#pragma once
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "ext/nats/connection.h"
#include "src/base/backoff.h"

namespace lidar::fleet {

class Reporter {
 public:
  /// Pairs of a subject and a text.
  using Reports = std::vector<std::pair<std::string, std::string>>;

  explicit Reporter(const nats::ConnectionSettings& settings);
  /// Waits if an attempt to connect is under way.
  ~Reporter();
  Reporter(const Reporter&) = delete;
  Reporter& operator=(const Reporter&) = delete;

  /// Queues reports for publication. They replace older reports that are still in the queue. Never
  /// waits.
  void Publish(Reports reports);

 private:
  using Clock = std::chrono::steady_clock;
  void Run();
  bool Connected(Clock::time_point now);
  void Open(Clock::time_point now);
  void Tell(const std::string& why);
  void Send(const Reports& reports) const;

  const nats::ConnectionSettings settings_;

  // Only the thread uses the following members.
  std::unique_ptr<nats::Connection> connection_;
  Backoff refusals_;
  Clock::time_point open_at_{};
  std::string told_;

  std::mutex mutex_;  // guards waiting_ and ending_
  std::condition_variable wake_;
  Reports waiting_;
  bool ending_ = false;

  std::thread thread_;  // declared last, because it uses the other members
};

}  // namespace lidar::fleet
