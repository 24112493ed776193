// SPDX-License-Identifier: LGPL-2.1-or-later
// lidar-link: a UDP relay that behaves like a bottleneck link in a 5G network.
#include <cstdio>
#include <iostream>

#include "src/tools/bench/lidar_link/options.h"
#include "src/tools/bench/lidar_link/recorder.h"
#include "src/tools/bench/lidar_link/relay.h"
#include "src/tools/common/event_loop.h"
#include "src/tools/common/output_file.h"
#include "src/tools/common/program.h"

namespace lidar::tools {
namespace {

void PrintLive(const LinkOptions& options, const nlohmann::ordered_json& line) {
  if (options.json_lines) {
    std::cout << line.dump() << std::endl;
    return;
  }
  std::printf(
      "%7.1f s  capacity %7.2f  delivered %7.2f Mbit/s  queue p50 %6.1f p95 %6.1f ms  "
      "CE %5d  dropped %4d\n",
      line["time_s"].get<double>(), line["capacity_bps"].get<double>() / 1e6,
      line["delivered_bps"].get<double>() / 1e6, line["sojourn_ms"]["p50"].get<double>(),
      line["sojourn_ms"]["p95"].get<double>(), line["marked"].get<int>(),
      line["dropped"].get<int>());
  std::fflush(stdout);
}

void WriteSummary(const std::string& name, const nlohmann::ordered_json& summary) {
  if (name == "-")
    std::cout << summary.dump(2) << std::endl;
  else if (!name.empty())
    WriteFile(name, summary.dump(2) + "\n");
}

int Run(const LinkOptions& options) {
  EventLoop loop;
  Recorder recorder(options.log);
  Relay relay(options, &loop, &recorder);
  RequestRealtimePriority();
  if (options.json_lines)
    std::cout << nlohmann::json{{"listening", relay.ListeningPorts()}}.dump() << std::endl;
  Time next_line = Time::max();
  loop.Run([&] {
    Time wake_up = relay.Pump();
    const link::Bottleneck* there = relay.there();
    if (there != nullptr) {
      const Time now = Now();
      if (next_line == Time::max()) next_line = relay.origin() + options.interval;
      if (now >= next_line) {
        const auto line = recorder.Live(now, *there, options.there.capacity);
        if (!options.quiet) PrintLive(options, line);
        while (next_line <= now) next_line += options.interval;
      }
      const bool bounded = options.duration < Duration::max();
      const Time end = bounded ? relay.origin() + options.duration : Time::max();
      if (now >= end) loop.Stop();
      wake_up = std::min({wake_up, next_line, end});
    }
    loop.SetWakeUp(wake_up);
  });
  WriteSummary(options.summary, recorder.Summary(Now(), relay.there(), options.there.capacity));
  recorder.Close();
  FinishStandardOutput();
  return 0;
}

}  // namespace
}  // namespace lidar::tools

int main(int argc, char** argv) {
  const auto options = lidar::tools::ParseLinkOptions(argc, argv);
  return lidar::tools::Guard("lidar-link", [&] { return lidar::tools::Run(options); });
}
