// SPDX-License-Identifier: LGPL-2.1-or-later
// Tells NATS of each robot, in a thread of its own and over a connection of its own.
#pragma once
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "ext/nats/connection.h"
#include "src/base/backoff.h"
#include "src/tools/edge/edge_config.h"

namespace lidar::edge {

class Reporter {
 public:
  /// What is published, by subject.
  using Reports = std::vector<std::pair<std::string, std::string>>;

  /// `collect` runs in the thread.
  Reporter(const EdgeConfig& config, std::function<Reports()> collect);
  /// May wait for a connect that is under way.
  ~Reporter();
  Reporter(const Reporter&) = delete;
  Reporter& operator=(const Reporter&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  void Run();
  bool Connected(Clock::time_point now);
  void Open(Clock::time_point now);

  const EdgeConfig& config_;
  const std::function<Reports()> collect_;

  // The thread's alone.
  std::unique_ptr<nats::Connection> connection_;
  Backoff refusals_;
  Clock::time_point open_at_{};
  std::string told_;

  std::mutex mutex_;  // guards what follows
  std::condition_variable wake_;
  bool ending_ = false;

  std::thread thread_;  // the last: it uses the rest
};

}  // namespace lidar::edge
