// SPDX-License-Identifier: LGPL-2.1-or-later
// lidar-trace: prints capacity traces for lidar-link and the demo, or what a sender could deliver
// over links with given traces.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "src/link/capacity.h"
#include "src/link/oracle.h"
#include "src/link/trace_maker.h"
#include "src/tools/common/output_file.h"
#include "src/tools/common/program.h"

namespace {

using lidar::DataRate;
using lidar::FromSeconds;

struct Options {
  double duration_s = 180;
  double rate_mbps = 8;
  double in_gaps_mbps = 0.2;
  std::uint64_t seed = 1;
  double gap_s = 0;
  double every_s = 2;
  std::vector<std::string> bound;  // FILE or FILE@SECONDS
};

DataRate Mbps(double m) { return DataRate::BitsPerSecond(m * 1e6); }

std::string Make(const Options& o) {
  if (o.gap_s <= 0)
    return lidar::link::MakeDriveTrace(
        {o.seed, FromSeconds(o.duration_s), Mbps(o.rate_mbps), Mbps(o.in_gaps_mbps)});
  return lidar::link::MakeGapTrace({Mbps(o.rate_mbps), Mbps(o.in_gaps_mbps), FromSeconds(o.gap_s),
                                    FromSeconds(o.every_s), FromSeconds(o.duration_s)});
}

/// Loads a trace from "FILE" or "FILE@SECONDS". SECONDS is the time in the file at which to start.
lidar::link::Capacity Load(const std::string& text) {
  const auto at = text.rfind('@');
  double start = 0;
  std::string path = text;
  if (at != std::string::npos && CLI::detail::lexical_cast(text.substr(at + 1), start))
    path = text.substr(0, at);
  std::ifstream file(path);
  std::stringstream lines;
  lines << file.rdbuf();
  if (!file) throw std::runtime_error("cannot read " + path);
  std::string error;
  const auto capacity = lidar::link::Capacity::ParseTrace(lines.str(), true, &error);
  if (!capacity) throw std::runtime_error(path + ": " + error);
  if (!(start >= 0 && start <= 86400))
    throw std::runtime_error(text + ": a trace starts between 0 and 86400 s");
  return capacity->StartingAt(FromSeconds(start));
}

void PrintRow(const std::string& name, const lidar::link::OracleResult& r) {
  const double whole =
      r.scans > 0 ? static_cast<double>(r.complete) / static_cast<double>(r.scans) : 0;
  std::printf("%-28s %8.2f %8.1f %8.1f %8.1f\n", name.c_str(), 100 * whole, r.Latency(50),
              r.Latency(95), r.Latency(99));
}

void PrintBound(const Options& o) {
  using lidar::link::Bonding;
  std::vector<lidar::link::Capacity> links;
  for (const std::string& text : o.bound) links.push_back(Load(text));
  lidar::link::OracleConfig config;
  config.rate = Mbps(o.rate_mbps);
  config.duration = FromSeconds(o.duration_s);
  std::printf("%-28s %8s %8s %8s %8s\n", "links", "whole %", "p50 ms", "p95 ms", "p99 ms");
  for (std::size_t i = 0; i < links.size(); ++i)
    PrintRow(o.bound[i], AskOracleOfLinks({links[i]}, config));
  if (links.size() == 1) return;
  PrintRow("all, where whole first", AskOracleOfLinks(links, config));
  PrintRow("all, a copy on each", AskOracleOfLinks(links, config, Bonding::kOnEach));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "lidar-trace: prints a capacity trace, lines of 'time_s rate_mbps', for lidar-link --trace.\n"
      "A drive through a 5G network with handover gaps of 0.1 to 2 s and fading cell edges, or\n"
      "with --gap, a constant rate with regular gaps. With --bound, what a sender that knew "
      "the\ntraces could deliver over their links.\n",
      "lidar-trace"};
  lidar::tools::AddVersionFlag(&app, "lidar-trace");
  Options o;
  const auto rate = CLI::Range(0.001, lidar::link::Capacity::kMaxMbps);
  app.add_option("--duration", o.duration_s, "Duration of the trace [s]")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str();
  app.add_option("--rate", o.rate_mbps, "Mean of a drive, or the rate outside of gaps [Mbit/s]")
      ->check(rate)
      ->capture_default_str();
  app.add_option("--gap-rate", o.in_gaps_mbps, "Rate in gaps [Mbit/s]")
      ->check(CLI::Range(0.0, lidar::link::Capacity::kMaxMbps))
      ->capture_default_str();
  app.add_option("--seed", o.seed, "Seed of the drive")->capture_default_str();
  auto* gap = app.add_option("--gap", o.gap_s, "Length of regular gaps [s]")
                  ->check(CLI::Range(0.001, 3600.0));
  app.add_option("--every", o.every_s, "Time from one gap's end to the next one's [s]")
      ->check(CLI::Range(0.002, 86400.0))
      ->needs(gap)
      ->capture_default_str();
  app.add_option(
         "--bound", o.bound,
         "Traces of links, FILE or FILE@SECONDS to start within: prints the share of 10 scans "
         "a second of 8 slices, --rate in all, that are whole within 0.2 s, and how long "
         "slices take at a round trip of 40 ms")
      ->expected(1, 8)
      ->excludes(gap);
  lidar::tools::Parse(&app, argc, argv, [&] {
    if (o.gap_s >= o.every_s) throw CLI::ValidationError("--gap", "must be shorter than --every");
  });
  return lidar::tools::Guard("lidar-trace", [&] {
    if (o.bound.empty())
      std::fputs(Make(o).c_str(), stdout);
    else
      PrintBound(o);
    lidar::tools::FinishStandardOutput();
    return 0;
  });
}
