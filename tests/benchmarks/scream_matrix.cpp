// SPDX-License-Identifier: LGPL-2.1-or-later
// scream-matrix: simulates the named scenarios, and prints a table of the results.
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "src/sim/scenarios.h"
#include "src/tools/common/program.h"
#include "tests/benchmarks/parameter_options.h"

namespace {

using lidar::Milliseconds;
using lidar::Seconds;
using lidar::scream::Parameters;
using namespace lidar::scream::test;

struct Options {
  std::vector<std::string> scenarios;
  Parameters parameters;
  std::string samples;
  double seconds = 0;
  double frame_jitter = -1;
  double frames_per_second = 0;
  double wakeup_ms = 0;
  double stall_ms = 0;
  double phase_ms = 0;
  std::uint64_t seed = 1;
};

void Parse(int argc, char** argv, Options* options) {
  CLI::App app{
      "scream-matrix: simulates SCReAM v2 over the scenarios (all by default) and prints one line "
      "each.",
      "scream-matrix"};
  app.add_option("SCENARIO", options->scenarios, "These only");
  app.add_option("--seconds", options->seconds, "Shorter (or longer) runs");
  app.add_option("--frames-per-second", options->frames_per_second, "Of every flow of ours");
  app.add_option("--frame-jitter", options->frame_jitter, "Frame sizes vary evenly by so much [%]");
  app.add_option("--wakeup-ms", options->wakeup_ms, "Pacing wakes up late by up to so much");
  app.add_option("--stall-ms", options->stall_ms,
                 "Sender and receiver stop for up to so much, once a second");
  app.add_option("--phase-ms", options->phase_ms, "Flows of ours start so much later");
  app.add_option("--seed", options->seed,
                 "Of all that is random: losses, jitter, frame sizes, late wake-ups");
  app.add_option("--samples", options->samples,
                 "Writes the controller's state every 10 ms (of one scenario) as CSV");
  AddParameterOptions(&app, &options->parameters);
  lidar::tools::Parse(&app, argc, argv, [options] {
    for (const std::string& name : options->scenarios)
      if (!FindScenario(name, options->parameters))
        throw CLI::ValidationError("SCENARIO", "no scenario is called " + name);
  });
}

bool WriteSamples(const std::string& path, const SimulationResult& result) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (file == nullptr) return false;
  std::fputs(
      "time_s,flow,capacity_mbps,target_mbps,sent_mbps,acked_mbps,ref_wnd,ref_wnd_i,bytes_in_"
      "flight,"
      "qdelay_ms,qdelay_avg_ms,s_rtt_ms,l4s_alpha,delay_scale,loss_rate,media_qdelay_ms\n",
      file);
  for (const Sample& s : result.samples) {
    const auto& t = s.statistics;
    std::fprintf(file,
                 "%.3f,%d,%.3f,%.3f,%.3f,%.3f,%lld,%lld,%lld,%.2f,%.2f,%.2f,%.4f,%.3f,%.4f,%.2f\n",
                 Seconds(s.time - result.config.forward.origin), s.flow, s.capacity_mbps,
                 t.target_bitrate.bits_per_second() / 1e6, t.sent_bitrate.bits_per_second() / 1e6,
                 t.acked_bitrate.bits_per_second() / 1e6, static_cast<long long>(t.ref_wnd.bytes()),
                 static_cast<long long>(t.ref_wnd_i.bytes()),
                 static_cast<long long>(t.bytes_in_flight.bytes()), Milliseconds(t.qdelay),
                 Milliseconds(t.qdelay_avg), Milliseconds(t.s_rtt), t.l4s_alpha,
                 t.ref_wnd_delay_scale, t.loss_rate, Milliseconds(t.media_qdelay));
  }
  return std::fclose(file) == 0;
}

void PrintRow(const Scenario& s, const ScenarioMetrics& m) {
  std::printf(
      "%-24s %5.1f  %5.1f %5.1f %6.1f %6.1f  %6.1f %6.1f %6.1f %6.1f  %5.2f  %5.3f  %5.2f %5.1f  "
      "%4.0f %4.0f",
      s.name.c_str(), 100 * m.utilisation, m.queue_ms.p50, m.queue_ms.p95, m.queue_ms.p99,
      m.queue_ms.max, m.frame_ms.p50, m.frame_ms.p95, m.frame_ms.p99, m.frame_ms.max,
      100 * m.own_loss, m.jain, m.start_s, m.start_peak_ms, m.frames_dropped, m.feedback_kbps);
  if (s.drop_at)
    std::printf("  drop: peak %.0f ms, <10 ms after %.2f s, rate after %.3f s",
                m.drop.peak_queue_ms, m.drop.recovered_s, m.drop.below_rate_s);
  if (m.beside)
    std::printf("  ours %.1f, theirs %.1f Mbit/s, loss %.2f and %.2f %%", m.beside->ours_mbps,
                m.beside->theirs_mbps, 100 * m.own_loss, 100 * m.beside->their_loss);
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  Parse(argc, argv, &options);
  std::printf("%-24s %5s  %-25s  %-27s  %5s  %5s  %-11s  %s\n", "scenario", "util%",
              "queue p50/p95/p99/max ms", "frame p50/p95/p99/max ms", "loss%", "Jain",
              "start s, ms", "dropped, feedback kbit/s");
  for (Scenario& s : Scenarios(options.parameters)) {
    bool wanted = options.scenarios.empty();
    for (const std::string& name : options.scenarios) wanted = wanted || name == s.name;
    if (!wanted) continue;
    if (options.seconds > 0) s.config.duration = lidar::FromSeconds(options.seconds);
    s.config.forward.seed = options.seed;
    for (FlowConfig& flow : s.config.flows) {
      if (options.frame_jitter >= 0) flow.sources[0].frame_jitter = options.frame_jitter / 100;
      if (options.frames_per_second > 0)
        flow.sources[0].frames_per_second = options.frames_per_second;
      flow.start += lidar::FromSeconds(options.phase_ms / 1e3);
      flow.stall = lidar::FromSeconds(options.stall_ms / 1e3);
      flow.wakeup_delay = lidar::FromSeconds(options.wakeup_ms / 1e3);
    }
    const SimulationResult result = Simulate(s.config);
    PrintRow(s, Measure(s, result));
    if (!options.samples.empty() && !WriteSamples(options.samples, result)) {
      std::fprintf(stderr, "scream-matrix: cannot write %s\n", options.samples.c_str());
      return 1;
    }
  }
  return 0;
}
