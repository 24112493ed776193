// SPDX-License-Identifier: LGPL-2.1-or-later
// Serves the newest statistics to Prometheus, on /metrics.
#pragma once
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "src/tools/common/file_descriptor.h"

namespace lidar::fleet {

/// Serves all connections by a single thread, which does not wait for any client. A silent or slow
/// client is disconnected after the timeout, or earlier if too many other clients connect.
class MetricsServer {
 public:
  static constexpr std::size_t kMaxConnections = 32;
  static constexpr std::chrono::milliseconds kClientTimeout{2'000};

  /// `port` may be 0 for any free port. Throws std::runtime_error if the port is not free.
  MetricsServer(const std::string& address, int port,
                std::chrono::milliseconds client_timeout = kClientTimeout);
  ~MetricsServer();
  MetricsServer(const MetricsServer&) = delete;
  MetricsServer& operator=(const MetricsServer&) = delete;

  int port() const { return port_; }
  /// Returns the number of connections that were closed before the whole answer was sent.
  std::uint64_t cut() const { return cut_; }
  void Publish(std::string text);

 private:
  using Clock = std::chrono::steady_clock;
  struct Connection {
    tools::FileDescriptor socket;
    Clock::time_point until;  // the connection is closed at this time at the latest
    std::string request;
    std::string answer;  // empty until the request is complete
    std::size_t sent = 0;
  };

  void Run();
  void Accept();
  bool GoesOn(Connection* connection);
  bool Receive(Connection* connection);
  std::string AnswerTo(const std::string& request);

  const std::chrono::milliseconds client_timeout_;
  tools::FileDescriptor listener_;
  tools::FileDescriptor wake_;  // an eventfd
  int port_ = 0;
  std::list<Connection> connections_;  // oldest first; used by the thread only
  std::atomic<std::uint64_t> cut_{0};
  std::mutex mutex_;  // guards text_
  std::shared_ptr<const std::string> text_ = std::make_shared<std::string>();
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace lidar::fleet
