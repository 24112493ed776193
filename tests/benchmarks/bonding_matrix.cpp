// SPDX-License-Identifier: LGPL-2.1-or-later
// bonding-matrix: simulates a stream over two links, and prints the tables of
// docs/results/two-links.md.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numeric>
#include <string>
#include <vector>

#include "src/link/oracle.h"
#include "src/link/trace_maker.h"
#include "src/sim/simulated_time.h"
#include "tests/core/bonding/bonded_run.h"

namespace {

using namespace std::chrono_literals;
using namespace lidar::bonding::test;
using lidar::Duration;
using lidar::Mbps;
using lidar::link::Capacity;
using lidar::scream::test::TcpKind;

constexpr std::uint64_t kPairs = 10;
constexpr unsigned kRuns = 20;
/// The other flow starts n * kPhase after the beginning of run n, so that the runs differ.
constexpr Duration kPhase = 137ms;

Capacity Drive(std::uint64_t seed) {
  lidar::link::DriveTraceConfig config;
  config.seed = seed;
  std::string error;
  return *Capacity::ParseTrace(lidar::link::MakeDriveTrace(config), true, &error);
}

double Rate(std::int64_t bytes, Duration time) {
  return static_cast<double>(bytes) * 8 / lidar::Seconds(time) / 1e6;
}

std::int64_t Sent(const RunResult& r) {
  return std::accumulate(r.link_bytes.begin(), r.link_bytes.end(), std::int64_t{0});
}

double Mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Returns half the width of the 95 % confidence interval of the mean, relative to the mean.
double Uncertainty(const std::vector<double>& values) {
  const double mean = Mean(values);
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const auto n = static_cast<double>(values.size());
  return 1.96 * std::sqrt(squares / (n - 1) / n) / mean;
}

/// Compares a stream over two generated drives with two ideal senders. Each of them sends the same
/// number of bytes as the stream, at a constant rate. The first knows the capacity of the drives in
/// advance, the second only after a round trip.
void PrintPair(std::uint64_t seed, bool adapts, Duration duration) {
  RunConfig config;
  config.links = {{Drive(seed)}, {Drive(seed + 1)}};
  config.duration = duration;
  config.source.adapts = adapts;
  const RunResult run = Simulate(config);
  lidar::link::OracleConfig oracle;
  oracle.duration = duration;
  oracle.rate = lidar::DataSize::Bytes(run.media_bytes) / duration;
  const std::vector<Capacity> links = {config.links[0].capacity, config.links[1].capacity};
  const auto bound = lidar::link::AskOracleOfLinks(links, oracle);
  oracle.known_after = oracle.rtt;
  const auto late = lidar::link::AskOracleOfLinks(links, oracle);
  const auto percent = [&bound](std::uint64_t scans) {
    return 100 * static_cast<double>(scans) / static_cast<double>(bound.scans);
  };
  std::printf(
      "| %ju, %ju | %s | %.2f | %.2f | %.2f | %.2f | %.0f, %.0f | %.0f, %.0f | "
      "%.0f |\n",
      static_cast<std::uintmax_t>(seed), static_cast<std::uintmax_t>(seed + 1),
      adapts ? "adapts" : "what 5 cm need", Rate(run.media_bytes, duration), 100 * run.Share(),
      percent(bound.complete), percent(late.complete), run.Latency(95), bound.Latency(95),
      run.Latency(99), bound.Latency(99),
      100 * (static_cast<double>(Sent(run)) / static_cast<double>(run.media_bytes) - 1));
}

void PrintDrives(Duration duration) {
  std::puts(
      "| seeds | encoder | Mbit/s | in time [%] | bound [%] | late bound [%] | "
      "p95, bound [ms] | p99, bound [ms] | sent twice [%] "
      "|\n|---|---|---|---|---|---|---|---|---|");
  for (const bool adapts : {false, true})
    for (std::uint64_t i = 0; i < kPairs; ++i) PrintPair(2 * i + 1, adapts, duration);
}

/// Simulates a greedy flow and a stream that share the queue of one bottleneck. The stream uses one
/// link to the bottleneck first, and two links in a second simulation.
void PrintOneBottleneck(TcpKind kind, double mbps, Duration duration) {
  LinkConfig link{Capacity::Constant(Mbps(mbps))};
  if (kind == TcpKind::kPrague)
    link.aqm.kind = lidar::link::AqmConfig::Kind::kRamp;
  else
    link.limit.time = 100ms;
  RunConfig config;
  config.links = {link};
  config.one_bottleneck = true;
  config.duration = duration;
  config.others.emplace_back().kind = kind;
  std::vector<double> one, both, others;
  for (unsigned run = 0; run < kRuns; ++run) {
    config.source.seed = run + 1;
    config.others[0].start = kPhase * run;
    config.links = {link};
    one.push_back(Rate(Sent(Simulate(config)), duration));
    config.links.push_back(link);
    const RunResult two = Simulate(config);
    both.push_back(Rate(Sent(two), duration));
    others.push_back(Rate(two.other_bytes, duration));
  }
  const double ratio = Mean(both) / Mean(one);
  std::printf("| %s | %.0f | %.2f | %.2f | %.2f ± %.2f | %.2f |\n",
              kind == TcpKind::kPrague ? "Prague, marks from 2 to 10 ms" : "Cubic, FIFO of 100 ms",
              mbps, Mean(one), Mean(both), ratio,
              ratio * std::hypot(Uncertainty(one), Uncertainty(both)), Mean(others));
}

void PrintBottlenecks(Duration duration) {
  std::puts(
      "| beside | Mbit/s | one link takes | two take | ratio | the other flow |\n"
      "|---|---|---|---|---|---|");
  for (const TcpKind kind : {TcpKind::kCubic, TcpKind::kPrague})
    for (const double mbps : {4, 8, 12, 20}) PrintOneBottleneck(kind, mbps, duration);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::fputs("usage: bonding-matrix drives|one-bottleneck [SECONDS]\n", stderr);
    return 2;
  }
  const Duration duration = lidar::FromSeconds(argc > 2 ? std::stod(argv[2]) : 60);
  if (std::strcmp(argv[1], "drives") == 0)
    PrintDrives(duration);
  else
    PrintBottlenecks(duration);
  return 0;
}
