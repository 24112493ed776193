// SPDX-License-Identifier: LGPL-2.1-or-later
// Serves the newest statistics to Prometheus, on /metrics.
#pragma once
#include <memory>
#include <string>

namespace lidar::fleet {

class MetricsServer {
 public:
  /// Port 0: any. Throws std::runtime_error where the port is taken.
  MetricsServer(const std::string& address, int port);
  ~MetricsServer();

  int port() const;
  void Publish(std::string text);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lidar::fleet
