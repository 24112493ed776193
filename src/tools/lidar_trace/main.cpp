// SPDX-License-Identifier: LGPL-2.1-or-later
// lidar-trace: prints capacity traces for lidar-link and the demo.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>

#include "src/link/capacity.h"
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
};

DataRate Mbps(double m) { return DataRate::BitsPerSecond(m * 1e6); }

std::string Make(const Options& o) {
  if (o.gap_s <= 0)
    return lidar::link::MakeDriveTrace(
        {o.seed, FromSeconds(o.duration_s), Mbps(o.rate_mbps), Mbps(o.in_gaps_mbps)});
  return lidar::link::MakeGapTrace({Mbps(o.rate_mbps), Mbps(o.in_gaps_mbps), FromSeconds(o.gap_s),
                                    FromSeconds(o.every_s), FromSeconds(o.duration_s)});
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "lidar-trace: prints a capacity trace, lines of 'time_s rate_mbps', for lidar-link --trace.\n"
      "A drive through a 5G network with handover gaps of 0.1 to 2 s and fading cell edges, or\n"
      "with --gap, a constant rate with regular gaps.\n",
      "lidar-trace"};
  lidar::tools::AddVersionFlag(&app, "lidar-trace");
  Options o;
  const auto rate = CLI::Range(0.001, lidar::link::Capacity::kMaxMbps);
  app.add_option("--duration", o.duration_s, "Of the trace [s]")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str();
  app.add_option("--rate", o.rate_mbps, "Of a drive its mean, else outside of gaps [Mbit/s]")
      ->check(rate)
      ->capture_default_str();
  app.add_option("--gap-rate", o.in_gaps_mbps, "In gaps [Mbit/s]")
      ->check(CLI::Range(0.0, lidar::link::Capacity::kMaxMbps))
      ->capture_default_str();
  app.add_option("--seed", o.seed, "Of the drive")->capture_default_str();
  auto* gap = app.add_option("--gap", o.gap_s, "Length of regular gaps [s]")
                  ->check(CLI::Range(0.001, 3600.0));
  app.add_option("--every", o.every_s, "Time from one gap's end to the next one's [s]")
      ->check(CLI::Range(0.002, 86400.0))
      ->needs(gap)
      ->capture_default_str();
  lidar::tools::Parse(&app, argc, argv, [&] {
    if (o.gap_s >= o.every_s) throw CLI::ValidationError("--gap", "must be shorter than --every");
  });
  return lidar::tools::Guard("lidar-trace", [&] {
    std::fputs(Make(o).c_str(), stdout);
    lidar::tools::FinishStandardOutput();
    return 0;
  });
}
