// SPDX-License-Identifier: LGPL-2.1-or-later
// lidar-edge: receives a fleet of robots and hands their streams on to NATS and to files.
#include <gst/gst.h>
#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <vector>

#include "ext/nats/connection.h"
#include "ext/nats/jetstream.h"
#include "src/tools/common/guard.h"
#include "src/tools/common/program.h"
#include "src/tools/edge/edge_config.h"
#include "src/tools/edge/metrics_server.h"
#include "src/tools/edge/receiver.h"

namespace lidar::edge {
namespace {

constexpr std::chrono::milliseconds kPoll{50};

std::atomic<bool> stopping{false};

EdgeConfig ReadConfig(const std::string& path) {
  std::ifstream in(path);
  std::stringstream text;
  text << in.rdbuf();
  if (!in) throw std::runtime_error("cannot read " + path);
  try {
    return ParseEdgeConfig(text.str());
  } catch (const std::exception& e) {
    throw std::runtime_error(path + ": " + e.what());
  }
}

/// Of the statistics alone: each robot's stream has a connection of its own.
std::unique_ptr<nats::Connection> Connect(const NatsConfig& nats) {
  if (nats.url.empty()) return nullptr;
  nats::ConnectionSettings settings;
  settings.url = nats.url;
  settings.name = "lidar-edge";
  settings.credentials_file = nats.credentials_file;
  settings.tls_ca_file = nats.tls_ca_file;
  settings.tls_cert_file = nats.tls_cert_file;
  settings.tls_key_file = nats.tls_key_file;
  std::string why;
  auto connection = nats::Connection::Open(settings, nullptr, &why);
  if (!connection) throw std::runtime_error("NATS cannot be used: " + why);
  return connection;
}

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

class Edge {
 public:
  explicit Edge(const EdgeConfig& config) : config_(config), connection_(Connect(config.nats)) {
    for (const RobotConfig& robot : config.robots)
      receivers_.push_back(std::make_unique<Receiver>(config, robot));
    if (config.http_port < 0) return;
    metrics_.emplace(config.http_address, config.http_port);
    std::printf("metrics http://%s:%d/metrics\n", config.http_address.c_str(), metrics_->port());
    std::fflush(stdout);
  }

  void Run() {
    MakeStream();
    auto tell_at = Receiver::Clock::now();
    while (!stopping) {
      const auto now = Receiver::Clock::now();
      for (const auto& receiver : receivers_) receiver->Poll(now);
      if (now >= tell_at) {
        Tell();
        tell_at = now + std::chrono::duration_cast<Receiver::Clock::duration>(
                            std::chrono::duration<double>(config_.interval_s));
      }
      std::this_thread::sleep_for(kPoll);
    }
  }

 private:
  /// One stream for all robots. Where the server is not there yet, their sinks make it.
  void MakeStream() {
    const NatsConfig& nats = config_.nats;
    if (nats.jetstream.empty() || !connection_->state().connected()) return;
    const auto js = lidar::nats::OpenJetStream(connection_->get());
    const lidar::nats::StreamSettings settings{nats.jetstream, std::chrono::seconds(nats.max_age_s),
                                               nats.max_bytes, 1};
    std::string why;
    if (!js || !lidar::nats::EnsureStream(js.get(), settings, {nats.prefix + ".*.lidar.>"}, &why))
      std::fprintf(stderr, "the stream %s cannot be made: %s\n", nats.jetstream.c_str(),
                   why.c_str());
  }

  void Tell() {
    if (connection_ && connection_->state().connected())
      for (const auto& receiver : receivers_) {
        const std::string subject = StatisticsSubject(config_.nats, receiver->robot());
        // Errors of the network may hold any bytes.
        const std::string text =
            receiver->Statistics().dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
        natsConnection_Publish(connection_->get(), subject.c_str(), text.data(),
                               static_cast<int>(text.size()));
      }
    if (!metrics_) return;
    Exposition exposition;
    AddProcess(&exposition);
    for (const auto& receiver : receivers_) receiver->AddTo(&exposition);
    metrics_->Publish(exposition.text());
  }

  const EdgeConfig& config_;
  std::unique_ptr<nats::Connection> connection_;
  std::vector<std::unique_ptr<Receiver>> receivers_;
  std::optional<MetricsServer> metrics_;
};

int Main(int argc, char** argv) {
  CLI::App app(
      "Receives a fleet of robots, each on a port of its own, and hands their streams on to NATS "
      "and to MCAP files. Statistics go to NATS as JSON, and to Prometheus.");
  tools::AddVersionFlag(&app, "lidar-edge");
  std::string path;
  bool check = false;
  app.add_option("CONFIG", path, "The configuration, JSON (see docs/fleet.md)")->required();
  app.add_flag("--check", check, "Read the configuration, and end");
  tools::Parse(&app, argc, argv);
  const EdgeConfig config = ReadConfig(path);
  if (check) return 0;
  gst_init(nullptr, nullptr);
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { stopping = true; });
  Edge(config).Run();
  return 0;
}

}  // namespace
}  // namespace lidar::edge

int main(int argc, char** argv) {
  return lidar::tools::Guard("lidar-edge", [&] { return lidar::edge::Main(argc, argv); });
}
