// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/apps/fleet/statistics.h"

#include <sys/resource.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <utility>

#include "src/tools/common/event_loop.h"
#include "src/tools/common/printable.h"

namespace lidar::fleet {
namespace {

void AddProcess(Exposition* exposition) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto time = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6;
  };
  exposition->Add("process_cpu_seconds_total", "", time(usage.ru_utime) + time(usage.ru_stime));
  std::ifstream in("/proc/self/statm");
  double pages = 0;
  double resident = 0;
  if (in >> pages >> resident)
    exposition->Add("process_resident_memory_bytes", "",
                    resident * static_cast<double>(sysconf(_SC_PAGESIZE)));
}

}  // namespace

Statistics::Statistics(const StatisticsSettings& settings,
                       const std::optional<nats::ConnectionSettings>& connection)
    : interval_(FromSeconds(settings.interval_s)) {
  if (connection) reporter_.emplace(*connection);
  if (settings.http_port < 0) return;
  metrics_.emplace(settings.http_address, settings.http_port);
  std::printf("metrics http://%s:%d/metrics\n", tools::HostInUrl(settings.http_address).c_str(),
              metrics_->port());
  std::fflush(stdout);
}

void Statistics::Poll(const Collect& collect) {
  const Time now = tools::Now();
  if ((!reporter_ && !metrics_) || now < tell_at_) return;
  tell_at_ = now + interval_;
  Exposition exposition;
  Reporter::Reports reports;
  AddProcess(&exposition);
  collect(&exposition, &reports);
  if (reporter_) reporter_->Publish(std::move(reports));
  if (!metrics_) return;
  exposition.Add("lidar_http_connections_cut", "", static_cast<double>(metrics_->cut()));
  metrics_->Publish(exposition.text());
}

}  // namespace lidar::fleet
