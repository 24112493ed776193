// SPDX-License-Identifier: LGPL-2.1-or-later
// loop-matrix: simulates an encoder, a sender and a link over traces with gaps. Prints their
// figures beside those of an ideal sender that knows the capacity of the link in advance.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <set>
#include <string>
#include <vector>

#include "src/sim/late_sender.h"
#include "src/sim/loop_goals.h"
#include "src/tools/common/program.h"
#include "tests/benchmarks/parameter_options.h"

namespace {

using lidar::Seconds;
using lidar::rate::DegradationPreference;
using namespace lidar::loop;

struct Variant {
  const char* name;
  void (*apply)(LoopCase*);
};
const std::vector<Variant> kVariants = {
    {"slices", [](LoopCase*) {}},
    {"scans", [](LoopCase* c) { c->source.slices = 1; }},
    {"framerate",
     [](LoopCase* c) { c->source.degradation = DegradationPreference::kMaintainFramerate; }},
    {"balanced", [](LoopCase* c) { c->source.degradation = DegradationPreference::kBalanced; }},
    {"intensity", [](LoopCase* c) { c->source.intensity_bits = 8; }},
    {"camera", [](LoopCase* c) { c->camera = true; }},
    {"fixed", [](LoopCase* c) { c->source.adapts = false; }},
    {"frames", [](LoopCase* c) { c->frames = true; }},
};

struct Options {
  std::vector<NamedTrace> traces;
  std::vector<std::string> variants;
  lidar::scream::Parameters parameters;
  double seconds = 60;
  double rtt_ms = 40;
  int starts = 1;
  // A value below 0 means that the loop itself is simulated, and not a late sender.
  double late_share = -1;
  std::string samples;
};

void TakeTraces(const std::vector<std::string>& names, const std::vector<std::string>& files,
                Options* options) {
  for (const std::string& file : files) {
    std::string error;
    const auto trace = ReadTrace(file, &error);
    if (!trace) throw CLI::ValidationError("--trace", error);
    options->traces.push_back(*trace);
  }
  const bool all = names.empty() && files.empty();
  for (const NamedTrace& trace : BuiltInTraces())
    if (all || std::find(names.begin(), names.end(), trace.name) != names.end())
      options->traces.push_back(trace);
  if (options->traces.empty()) throw CLI::ValidationError("TRACE", "no trace has such a name");
}

void Parse(int argc, char** argv, Options* options) {
  CLI::App app{
      "loop-matrix: simulates a LiDAR stream (1.4 to 10 Mbit/s) over traces with gaps, one line a "
      "run.",
      "loop-matrix"};
  app.footer(
      "Columns: scans captured, left out by the encoder, complete, of these in time; complete over "
      "the oracle's;\n"
      "capture to cloud p50/p95/p99 and the oracle's p95 [ms]; utilisation of what link and "
      "source\n"
      "can do [%]; queue p50/p95/p99/max [ms]; back at 80 % after a gap, p50/p95/max [s].\n"
      "Goals that a run does not reach stand below its line.");
  std::vector<std::string> names;
  std::vector<std::string> files;
  std::set<std::string> variants;
  for (const Variant& variant : kVariants) variants.insert(variant.name);
  app.add_option("TRACE", names, "A built-in trace (all by default; a drive_N is generated)");
  app.add_option("--trace", files, "Lines of 'time_s rate_mbps'")->allow_extra_args(false);
  app.add_option("--variant", options->variants,
                 "slices, scans (whole ones), framerate and balanced (what gives below the "
                 "minimum), intensity, camera (a video beside), fixed (no adaptation), frames "
                 "(50/s, obeys exactly)")
      ->check(CLI::IsMember(variants))
      ->allow_extra_args(false);
  app.add_option("--seconds", options->seconds, "Length of a run")->check(CLI::PositiveNumber);
  app.add_option("--rtt", options->rtt_ms, "Of the path [ms]");
  app.add_option("--starts", options->starts,
                 "Runs for each line, each of another scene, that begin 7.33 s apart in the trace; "
                 "prints means and, in brackets, the lowest and the highest")
      ->check(CLI::PositiveNumber);
  app.add_option("--late", options->late_share,
                 "Instead: a sender that knows what the link carries, one round trip late, and "
                 "sends this share of it; beside one that always sends the lowest rate");
  app.add_option("--samples", options->samples,
                 "Writes the sender's state every 10 ms (of one run) as CSV");
  lidar::scream::test::AddParameterOptions(&app, &options->parameters);
  lidar::tools::Parse(&app, argc, argv, [&] { TakeTraces(names, files, options); });
}

bool WriteSamples(const std::string& path, const lidar::scream::test::SimulationResult& result) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (file == nullptr) return false;
  std::fputs(
      "time_s,capacity_mbps,target_mbps,sent_mbps,acked_mbps,ref_wnd,bytes_in_flight,qdelay_ms,"
      "s_rtt_ms,media_qdelay_ms,reason\n",
      file);
  for (const auto& s : result.samples) {
    const auto& t = s.statistics;
    std::fprintf(file, "%.3f,%.3f,%.3f,%.3f,%.3f,%lld,%lld,%.2f,%.2f,%.2f,%s\n",
                 Seconds(s.time - result.config.forward.origin), s.capacity_mbps,
                 t.target_bitrate.bits_per_second() / 1e6, t.sent_bitrate.bits_per_second() / 1e6,
                 t.acked_bitrate.bits_per_second() / 1e6, static_cast<long long>(t.ref_wnd.bytes()),
                 static_cast<long long>(t.bytes_in_flight.bytes()), lidar::Milliseconds(t.qdelay),
                 lidar::Milliseconds(t.s_rtt), lidar::Milliseconds(t.media_qdelay),
                 ToString(t.reason));
  }
  return std::fclose(file) == 0;
}

void PrintHeader() {
  std::printf("%-34s %5s %5s %5s %5s  %6s  %22s %6s  %5s  %27s  %16s\n", "trace/variant", "scans",
              "out", "whole", "time", "oracle", "capture to cloud [ms]", "oracle", "util",
              "queue [ms]", "back [s]");
}

void PrintShort(const GoalResult& goal) {
  if (!goal.holds) std::printf("    short: %s\n", goal.text.c_str());
}

/// Compares the encoder that adapts its step with an encoder that always uses the coarsest step.
/// Prints the goal that is missed, if any.
void CompareWithFixed(LoopCase c, const LoopReport& report) {
  if (c.frames || !c.source.adapts) return;
  c.source.adapts = false;
  PrintShort(CheckAgainstFixed(report, RunLoop(c).report));
}

void PrintRow(const LoopCase& c, const LoopReport& r) {
  std::printf(
      "%-34s %5llu %5llu %5llu %5llu ", c.name.c_str(), static_cast<unsigned long long>(r.captured),
      static_cast<unsigned long long>(r.skipped), static_cast<unsigned long long>(r.complete),
      static_cast<unsigned long long>(r.in_time));
  if (c.frames)
    std::printf(" %6s ", "-");
  else
    std::printf(" %5.1f%% ", 100 * r.OfOracle());
  std::printf(" %6.1f %7.1f %7.1f %6.1f  %5.1f  %5.1f %6.1f %7.1f %6.1f  %4.2f %5.2f %5.2f\n",
              r.capture_to_cloud_ms.p50, r.capture_to_cloud_ms.p95, r.capture_to_cloud_ms.p99,
              r.oracle_at_mean.Latency(95), 100 * r.utilisation, r.queue_ms.p50, r.queue_ms.p95,
              r.queue_ms.p99, r.queue_ms.max, r.recovery_s.p50, r.recovery_s.p95, r.recovery_s.max);
  for (const GoalResult& goal : CheckGoals(c, r)) PrintShort(goal);
  CompareWithFixed(c, r);
  std::fflush(stdout);
}

/// The mean, the least and the greatest value of a figure over several runs.
class Spread {
 public:
  void Add(double value) {
    lowest_ = runs_ == 0 ? value : std::min(lowest_, value);
    highest_ = runs_ == 0 ? value : std::max(highest_, value);
    sum_ += value;
    ++runs_;
  }
  std::string Text(int digits) const {
    char text[80];
    std::snprintf(text, sizeof text, "%.*f (%.*f..%.*f)", digits, sum_ / runs_, digits, lowest_,
                  digits, highest_);
    return text;
  }

 private:
  double sum_ = 0, lowest_ = 0, highest_ = 0;
  int runs_ = 0;
};

/// A figure that PrintSpread() prints with `digits` decimals.
struct Figure {
  const char* name;
  int digits;
  double (*of)(const LoopReport& report, const LoopReport& fixed);
};
double Count(std::uint64_t n) { return static_cast<double>(n); }
const std::vector<Figure> kFigures = {
    {"complete", 1, [](const LoopReport& r, const LoopReport&) { return Count(r.complete); }},
    {"of a fixed step [%]", 1,
     [](const LoopReport& r, const LoopReport& f) {
       return 100 * Count(r.complete) / std::max(1.0, Count(f.complete));
     }},
    {"in time", 1, [](const LoopReport& r, const LoopReport&) { return Count(r.in_time); }},
    {"of a fixed step [%]", 1,
     [](const LoopReport& r, const LoopReport& f) {
       return 100 * Count(r.in_time) / std::max(1.0, Count(f.in_time));
     }},
    {"of the oracle [%]", 1,
     [](const LoopReport& r, const LoopReport&) { return 100 * r.OfOracle(); }},
    {"utilisation [%]", 1,
     [](const LoopReport& r, const LoopReport&) { return 100 * r.utilisation; }},
    {"p95 over the oracle's [ms]", 0,
     [](const LoopReport& r, const LoopReport&) {
       return r.capture_to_cloud_ms.p95 - r.oracle_at_mean.Latency(95);
     }},
    {"queue p95 [ms]", 1, [](const LoopReport& r, const LoopReport&) { return r.queue_ms.p95; }},
    {"longest way back [s]", 2,
     [](const LoopReport& r, const LoopReport&) { return r.recovery_s.max; }},
};

void PrintSpread(const LoopCase& loop_case, int starts) {
  std::vector<Spread> spreads(kFigures.size());
  for (int n = 0; n < starts; ++n) {
    LoopCase c = Later(loop_case, n);
    const LoopReport report = RunLoop(c).report;
    c.source.adapts = false;
    const LoopReport fixed = RunLoop(c).report;
    for (std::size_t i = 0; i < kFigures.size(); ++i) spreads[i].Add(kFigures[i].of(report, fixed));
  }
  std::printf("%s\n", loop_case.name.c_str());
  for (std::size_t i = 0; i < kFigures.size(); ++i)
    std::printf("    %-28s %s\n", kFigures[i].name, spreads[i].Text(kFigures[i].digits).c_str());
  std::fflush(stdout);
}

/// Prints the figures of a sender that uses a `share` of the link's capacity, but learns of each
/// change late. Senders that adapt are compared with these figures.
void PrintLate(const LoopCase& loop_case, double share, int starts) {
  LateSenderConfig config;
  config.duration = loop_case.duration;
  config.rtt = loop_case.rtt;
  config.slices_per_scan = loop_case.source.slices;
  config.scans_per_second = loop_case.source.scans_per_second;
  Spread complete, in_time, utilisation, queue;
  for (int n = 0; n < starts; ++n) {
    const LoopCase c = Later(loop_case, n);
    const LoopReport run = RunLoop(c).report;
    config.min = lidar::DataRate::BitsPerSecond(run.min_mbps * 1e6);
    config.max = lidar::DataRate::BitsPerSecond(run.max_mbps * 1e6);
    config.share = share;
    const LateSenderReport late = SendLate(c.capacity, config);
    config.share = 0;
    const LateSenderReport fixed = SendLate(c.capacity, config);
    complete.Add(100 * Count(late.complete) / Count(fixed.complete));
    in_time.Add(100 * Count(late.in_time) / Count(fixed.in_time));
    utilisation.Add(100 * late.utilisation);
    queue.Add(late.queue_p95_ms);
  }
  std::printf(
      "%s: complete %s %% of a fixed step's, in time %s %%, utilisation %s %%, queue p95 %s ms\n",
      loop_case.name.c_str(), complete.Text(1).c_str(), in_time.Text(1).c_str(),
      utilisation.Text(0).c_str(), queue.Text(1).c_str());
  std::fflush(stdout);
}

bool Wanted(const Options& options, const Variant& variant) {
  if (options.variants.empty()) return true;
  for (const std::string& name : options.variants)
    if (name == variant.name) return true;
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  Parse(argc, argv, &options);
  if (options.starts == 1 && options.late_share < 0) PrintHeader();
  for (const NamedTrace& trace : options.traces) {
    for (const Variant& variant : kVariants) {
      if (!Wanted(options, variant)) continue;
      LoopCase loop_case;
      loop_case.name = trace.name + "/" + variant.name;
      loop_case.capacity = trace.capacity;
      loop_case.duration = lidar::FromSeconds(options.seconds);
      loop_case.rtt = lidar::FromSeconds(options.rtt_ms / 1e3);
      loop_case.parameters = options.parameters;
      variant.apply(&loop_case);
      if (options.late_share >= 0) {
        PrintLate(loop_case, options.late_share, options.starts);
        break;
      }
      if (options.starts > 1) {
        PrintSpread(loop_case, options.starts);
        continue;
      }
      const LoopRun run = RunLoop(loop_case);
      PrintRow(loop_case, run.report);
      if (!options.samples.empty() && !WriteSamples(options.samples, run.simulation)) return 1;
    }
  }
  return 0;
}
