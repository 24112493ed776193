// SPDX-License-Identifier: LGPL-2.1-or-later
// lidar-worker: computes the poses of robots by odometry. When it ends, other workers continue.
#include <gst/gst.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <csignal>
#include <string>
#include <thread>

#include "ext/nats/jetstream.h"
#include "src/base/backoff.h"
#include "src/tools/apps/fleet/statistics.h"
#include "src/tools/apps/worker/worker.h"
#include "src/tools/common/bounded_end.h"
#include "src/tools/common/event_loop.h"
#include "src/tools/common/program.h"

namespace lidar::worker {
namespace {

// The longest time that the end may take, even if servers hang.
constexpr std::chrono::milliseconds kEnd{900};
// Pauses between attempts to connect while no server answers.
constexpr std::chrono::seconds kFirstPause{1};
constexpr std::chrono::seconds kLongestPause{16};
constexpr std::chrono::milliseconds kPoll{50};

std::atomic<bool> stopping{false};

/// Returns a name that no other process ever has.
std::string NameOfThisProcess() {
  char host[65] = "";
  gethostname(host, sizeof host - 1);
  return std::string(host) + "-" + std::to_string(getpid()) + "-" + std::to_string(g_random_int());
}

/// The options of the command line.
struct Options {
  WorkerSettings worker;
  fleet::StatisticsSettings statistics;
  std::vector<std::string> odometry;
  double rewind_s = Seconds(worker.pipeline.rewind);
  int lease_ms = static_cast<int>(Milliseconds(worker.lease.lease));
};

std::vector<std::pair<std::string, std::string>> ParseProperties(
    const std::vector<std::string>& list) {
  std::vector<std::pair<std::string, std::string>> properties;
  for (const std::string& text : list) {
    const auto at = text.find('=');
    if (at == text.npos || at == 0)
      throw CLI::ValidationError("--odometry", "\"" + text + "\" is not KEY=VALUE");
    properties.emplace_back(text.substr(0, at), text.substr(at + 1));
  }
  return properties;
}

void CheckWord(const std::string& option, const std::string& value) {
  const std::string why = value.empty() ? "it is empty" : nats::CheckName(value);
  if (!why.empty()) throw CLI::ValidationError(option, "\"" + value + "\": " + why);
}

void AddConnection(CLI::App* app, nats::ConnectionSettings* c) {
  app->add_option("--url", c->url,
                  "URL of the server, or of several servers of a cluster, comma-separated")
      ->capture_default_str();
  app->add_option("--credentials-file", c->credentials_file, "File with user and key (.creds)");
  app->add_option("--tls-ca-file", c->tls_ca_file, "File with the authorities to trust (PEM)");
  app->add_option("--tls-cert-file", c->tls_cert_file, "File with the client's certificate (PEM)");
  app->add_option("--tls-key-file", c->tls_key_file,
                  "File with the private key of --tls-cert-file (PEM)");
}

void AddStatistics(CLI::App* app, fleet::StatisticsSettings* s) {
  app->add_option("--http-port", s->http_port,
                  "TCP port where Prometheus reads /metrics; 0: any, which is printed")
      ->check(CLI::Range(0, 65'535));
  app->add_option("--http-address", s->http_address, "Local address for --http-port")
      ->capture_default_str();
  app->add_option("--interval", s->interval_s, "Time between statistics [s]")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
}

void AddFleet(CLI::App* app, WorkerSettings* s) {
  app->add_option("ROBOT", s->fleet.patterns,
                  "Robots to care for, such as r7, r7.front or '*'; * and ? are wildcards")
      ->required();
  app->add_option("--max-robots", s->lease.most, "Most robots at a time")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
  AddConnection(app, &s->pipeline.connection);
  app->add_option("--prefix", s->fleet.prefix, "First word of all subjects")->capture_default_str();
  app->add_option("--jetstream", s->fleet.stream, "JetStream's stream that keeps the slices")
      ->capture_default_str();
  app->add_option("--bucket", s->fleet.bucket, "Bucket of the key-value store for leases and poses")
      ->capture_default_str();
  app->add_option("--replicas", s->fleet.replicas,
                  "Number of servers that keep a copy of the bucket, if this program creates it")
      ->check(CLI::Range(1, 5))
      ->capture_default_str();
}

void AddWork(CLI::App* app, Options* o) {
  app->add_option("--lease", o->lease_ms,
                  "Longest silence of a worker before others take over [ms]")
      ->check(CLI::Range(200, 60'000))
      ->capture_default_str();
  app->add_option("--decoder", o->worker.pipeline.decoder,
                  "lidardec, or dracodec for streams of dracoenc")
      ->capture_default_str();
  app->add_option("--rewind", o->rewind_s,
                  "Time of slices that the decoder reads before it continues: the key-interval of "
                  "the robots' lidarenc, and a little more [s]")
      ->check(CLI::Range(0.0, 60.0))
      ->capture_default_str();
  app->add_option("--odometry", o->odometry, "Property of lidarodometry, such as voxel-size=0.5");
}

Options ParseOptions(int argc, char** argv) {
  CLI::App app(
      "Takes robots whose streams JetStream keeps, finds their poses by lidarodometry, and "
      "publishes them. Several workers share the robots: each robot has one worker at a time, and "
      "if a worker ends, another continues from the last pose.");
  tools::AddVersionFlag(&app, "lidar-worker");
  Options o;
  WorkerSettings& s = o.worker;
  AddFleet(&app, &s);
  AddWork(&app, &o);
  AddStatistics(&app, &o.statistics);
  tools::Parse(&app, argc, argv, [&] {
    CheckWord("--prefix", s.fleet.prefix);
    CheckWord("--jetstream", s.fleet.stream);
    CheckWord("--bucket", s.fleet.bucket);
    s.pipeline.odometry = ParseProperties(o.odometry);
  });
  s.pipeline.prefix = s.fleet.prefix;
  s.pipeline.stream = s.fleet.stream;
  s.pipeline.rewind = FromSeconds(o.rewind_s);
  s.lease.lease = std::chrono::milliseconds(o.lease_ms);
  s.lease.worker = NameOfThisProcess();
  return o;
}

int Main(int argc, char** argv) {
  Options o = ParseOptions(argc, argv);
  gst_init(nullptr, nullptr);
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { stopping = true; });
  std::optional<Worker> worker(std::in_place, o.worker);
  o.worker.pipeline.connection.name = "lidar-worker";
  std::optional<fleet::Statistics> statistics(std::in_place, o.statistics,
                                              o.worker.pipeline.connection);
  Backoff pauses(kFirstPause, kLongestPause);
  Time open_at = tools::Now() + pauses.Next();
  while (!stopping) {
    if (!worker->unanswered()) {
      worker->Step();
    } else if (tools::Now() < open_at) {
      std::this_thread::sleep_for(kPoll);
    } else {
      worker.emplace(o.worker);
      open_at = tools::Now() + pauses.Next();
    }
    statistics->Poll([&](auto* exposition, auto* reports) { worker->Tell(exposition, reports); });
  }
  const tools::BoundedEnd bounded(kEnd);
  worker->HandOver();
  statistics.reset();
  worker.reset();
  return 0;
}

}  // namespace
}  // namespace lidar::worker

int main(int argc, char** argv) {
  return lidar::tools::Guard("lidar-worker", [&] { return lidar::worker::Main(argc, argv); });
}
