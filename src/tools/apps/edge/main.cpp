// SPDX-License-Identifier: LGPL-2.1-or-later
// lidar-edge: receives the streams of a fleet of robots, and forwards them to NATS and to files.
#include <gst/gst.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <vector>

#include "src/tools/apps/edge/edge_config.h"
#include "src/tools/apps/edge/receiver.h"
#include "src/tools/apps/edge/shared_port.h"
#include "src/tools/apps/fleet/statistics.h"
#include "src/tools/common/bounded_end.h"
#include "src/tools/common/program.h"

namespace lidar::edge {
namespace {

constexpr std::chrono::milliseconds kPoll{50};
// The longest time that the end may take if a server, disk or client hangs.
constexpr std::chrono::seconds kEnd{6};

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

class Edge {
 public:
  explicit Edge(const EdgeConfig& config) : config_(config) {
    std::vector<SsrcRange> ranges;
    for (const RobotConfig& robot : config.robots)
      if (robot.ssrc) ranges.push_back(*robot.ssrc);
    if (!ranges.empty()) shared_port_.emplace(config.address, config.port, ranges);
    std::size_t next = 0;
    for (const RobotConfig& robot : config.robots)
      receivers_.push_back(std::make_unique<Receiver>(
          config, robot, robot.ssrc ? shared_port_->socket(next++) : nullptr));
    std::optional<nats::ConnectionSettings> connection = config.nats.connection;
    if (connection) connection->name = "lidar-edge";  // name in the server's monitoring
    statistics_.emplace(
        fleet::StatisticsSettings{config.http_address, config.http_port, config.interval_s},
        connection);
  }
  /// Asks all receivers to end at the same time. Otherwise their destructors would wait for one
  /// session after another.
  ~Edge() {
    for (const auto& receiver : receivers_) receiver->AskToEnd();
  }

  void Run() {
    while (!stopping) {
      std::this_thread::sleep_for(kPoll);
      statistics_->Poll([this](auto* exposition, auto* reports) { Tell(exposition, reports); });
    }
  }

 private:
  void Tell(fleet::Exposition* exposition, fleet::Reporter::Reports* reports) const {
    if (shared_port_) exposition->Add("lidar_edge_stray_datagrams", "", shared_port_->strays());
    for (const auto& receiver : receivers_) {
      const Session& session = receiver->session();
      reports->emplace_back(StatisticsSubject(config_.nats, session.robot()),
                            fleet::ToText(session.Tell(exposition)));
    }
  }

  const EdgeConfig& config_;
  std::optional<SharedPort> shared_port_;
  std::vector<std::unique_ptr<Receiver>> receivers_;
  std::optional<fleet::Statistics> statistics_;
};

int Main(int argc, char** argv) {
  CLI::App app(
      "Receives a fleet of robots, each on a port of its own or all on one, publishes their "
      "streams to NATS, and records them as MCAP files. Statistics go to NATS as JSON, and to "
      "Prometheus.");
  tools::AddVersionFlag(&app, "lidar-edge");
  std::string path;
  bool check = false;
  app.add_option("CONFIG", path, "The configuration, JSON (see docs/fleet.md)")->required();
  app.add_flag("--check", check, "Check the configuration, and exit");
  tools::Parse(&app, argc, argv);
  const EdgeConfig config = ReadConfig(path);
  if (check) return 0;
  gst_init(nullptr, nullptr);
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { stopping = true; });
  std::optional<Edge> edge(std::in_place, config);
  edge->Run();
  const tools::BoundedEnd bounded(kEnd);
  edge.reset();
  return 0;
}

}  // namespace
}  // namespace lidar::edge

int main(int argc, char** argv) {
  return lidar::tools::Guard("lidar-edge", [&] { return lidar::edge::Main(argc, argv); });
}
