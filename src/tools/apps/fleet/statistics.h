// SPDX-License-Identifier: LGPL-2.1-or-later
// Tells of a program and its robots at intervals: as JSON on NATS, and to Prometheus.
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
  int http_port = -1;  // -1: none; 0: any
  double interval_s = 5;
};

/// For one thread.
class Statistics {
 public:
  /// If `connection` is missing, NATS gets nothing. Prints where Prometheus finds it. Throws
  /// std::runtime_error where the port is taken.
  Statistics(const StatisticsSettings& settings,
             const std::optional<nats::ConnectionSettings>& connection);

  /// Has `collect` say what there is, once an interval. Waits for no server and no client.
  using Collect = std::function<void(Exposition*, Reporter::Reports*)>;
  void Poll(const Collect& collect);

 private:
  const Duration interval_;
  Time tell_at_{};
  std::optional<Reporter> reporter_;
  std::optional<MetricsServer> metrics_;
};

}  // namespace lidar::fleet
