// SPDX-License-Identifier: LGPL-2.1-or-later
// Reports the figures of a program and its robots at intervals, to NATS as JSON and to Prometheus.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "ext/nats/connection.h"
#include "src/base/time.h"
#include "src/tools/apps/fleet/exposition.h"
#include "src/tools/apps/fleet/metrics_server.h"
#include "src/tools/apps/fleet/reporter.h"

namespace lidar::fleet {

struct StatisticsSettings {
  std::string http_address = "127.0.0.1";
  int http_port = -1;  // -1: no server; 0: any port
  double interval_s = 5;
};

/// Publishes statistics at intervals. Only one thread may use it.
class Statistics {
 public:
  /// If `connection` is missing, nothing is published to NATS. Prints the address for Prometheus.
  /// Throws std::runtime_error if the port is not free.
  Statistics(const StatisticsSettings& settings,
             const std::optional<nats::ConnectionSettings>& connection);

  using Collect = std::function<void(Exposition*, Reporter::Reports*)>;
  /// Calls `collect` once per interval, and publishes the result. Does not wait for a server or a
  /// client.
  void Poll(const Collect& collect);

 private:
  const Duration interval_;
  Time tell_at_{};
  std::optional<Reporter> reporter_;
  std::optional<MetricsServer> metrics_;
};

}  // namespace lidar::fleet
