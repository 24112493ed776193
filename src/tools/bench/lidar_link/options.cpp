// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/lidar_link/options.h"

#include <CLI/CLI.hpp>
#include <fstream>
#include <map>
#include <sstream>

#include "src/tools/common/program.h"

namespace lidar::tools {
namespace {

using Kind = link::AqmConfig::Kind;

/// The options of the command line, in the units of the command line.
struct Text {
  double rate_mbps = 12;
  std::vector<double> steps_mbps;
  double step_time_s = 10;
  std::string trace;
  bool once = false;
  std::vector<std::string> outages;
  double rtt_ms = 40;
  double queue_ms = 0;
  std::int64_t queue_bytes = 0;
  Kind aqm = Kind::kRamp;
  double aqm_low_ms = 2;
  double aqm_high_ms = 10;
  double aqm_target_ms = 15;
  bool aqm_classic = false;
  struct Way {
    double loss_percent = 0;
    double extra_delay_ms = 0;
    double jitter_ms = 0;
    double burst_ms = 0;
    double reorder_percent = 0;
    double reorder_delay_ms = 5;
    double duplicate_percent = 0;
  };
  Way there;
  Way back;
  std::uint64_t seed = 1;
  double duration_s = 0;
  double interval_s = 1;
};

DataRate Mbps(double m) { return DataRate::BitsPerSecond(m * 1e6); }
Duration Ms(double ms) { return FromSeconds(ms / 1e3); }

void AddWayOptions(CLI::App* app, const std::string& prefix, const std::string& way, Text::Way* w) {
  const auto percent = CLI::Range(0.0, 100.0);
  const auto ms = CLI::Range(0.0, 3600e3);
  const auto add = [&](const char* name, double* value, const char* what, const CLI::Validator& v) {
    app->add_option(prefix + name, *value, std::string(what) + ", " + way)->check(v);
  };
  add("loss", &w->loss_percent, "Random loss [%]", percent);
  add("delay", &w->extra_delay_ms, "Delay besides half of --rtt [ms]", ms);
  add("jitter", &w->jitter_ms, "Delay drawn anew for each packet, up to [ms]; keeps the order", ms);
  add("burst", &w->burst_ms, "Packets come out only every so often [ms]", ms);
  add("reorder", &w->reorder_percent, "Packets held back by --reorder-delay [%]", percent);
  add("reorder-delay", &w->reorder_delay_ms, "How long these are held back [ms]", ms);
  add("duplicate", &w->duplicate_percent, "Packets that arrive twice [%]", percent);
}

void AddLinkOptions(CLI::App* app, Text* t) {
  const auto rate = CLI::Range(0.0, link::Capacity::kMaxMbps);
  const auto ms = CLI::Range(0.0, 3600e3);
  auto* constant = app->add_option("--rate", t->rate_mbps, "Capacity [Mbit/s]")->check(rate);
  auto* steps = app->add_option("--steps", t->steps_mbps, "Capacities [Mbit/s], comma-separated")
                    ->delimiter(',')
                    ->check(rate)
                    ->excludes(constant);
  app->add_option("--step-time", t->step_time_s, "How long each of --steps lasts [s]")
      ->check(CLI::Range(0.001, 1e6))
      ->needs(steps);
  app->add_option("--trace", t->trace, "Capacity from a file of 'time_s rate_mbps' lines")
      ->check(CLI::ExistingFile)
      ->excludes(constant)
      ->excludes(steps);
  app->add_flag("--once", t->once, "Keep the last rate of --steps or --trace, don't start again");
  app->add_option("--outage", t->outages, "Link down, FROM:UNTIL [s]; repeatable");
  app->add_option("--rtt", t->rtt_ms, "Propagation there and back, half each way [ms]")->check(ms);
  app->add_option("--queue", t->queue_ms, "Queue limit as time at the current rate [ms]; 0: none")
      ->check(ms);
  app->add_option("--queue-bytes", t->queue_bytes, "Queue limit [bytes]; 0: 16 MiB")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1} << 30));
  const std::map<std::string, Kind> kinds{{"none", Kind::kNone},
                                          {"step", Kind::kStep},
                                          {"ramp", Kind::kRamp},
                                          {"pi2", Kind::kPi2},
                                          {"dualpi2", Kind::kDualPi2}};
  app->add_option("--aqm", t->aqm,
                  "Marking of ECT(1) by sojourn time: none, step (at --aqm-high), ramp; pi2 and\n"
                  "dualpi2 (RFC 9332) also signal classic packets")
      ->transform(CLI::CheckedTransformer(kinds, CLI::ignore_case)
                      .description("none|step|ramp|pi2|dualpi2"));
  app->add_option("--aqm-low", t->aqm_low_ms, "No mark below this sojourn [ms]")->check(ms);
  app->add_option("--aqm-high", t->aqm_high_ms, "Every packet marked above this sojourn [ms]")
      ->check(ms);
  app->add_option("--aqm-target", t->aqm_target_ms, "pi2, dualpi2: classic queue delay [ms]")
      ->check(ms);
  app->add_flag("--aqm-classic", t->aqm_classic,
                "pi2: mark ECT(1) no more often than ECT(0), as queues that know no L4S do");
  AddWayOptions(app, "--", "on the way there", &t->there);
  AddWayOptions(app, "--back-", "on the way back", &t->back);
  app->add_option("--seed", t->seed, "Seed of everything random");
}

link::Capacity ReadCapacity(const Text& t) {
  if (!t.trace.empty()) {
    std::ifstream file(t.trace);
    std::stringstream text;
    text << file.rdbuf();
    std::string error;
    auto capacity = link::Capacity::ParseTrace(text.str(), !t.once, &error);
    if (!capacity) throw CLI::ValidationError("--trace", t.trace + ": " + error);
    return *capacity;
  }
  if (t.steps_mbps.empty()) return link::Capacity::Constant(Mbps(t.rate_mbps));
  std::vector<DataRate> rates;
  for (const double m : t.steps_mbps) rates.push_back(Mbps(m));
  return link::Capacity::Steps(rates, FromSeconds(t.step_time_s), !t.once);
}

void AddOutages(const Text& t, link::Capacity* capacity) {
  for (const std::string& text : t.outages) {
    double from = 0;
    double until = 0;
    char colon = 0;
    std::istringstream in(text);
    if (!(in >> from >> colon >> until) || colon != ':' || !in.eof() || !(from >= 0) ||
        !(until > from) || !(until < 1e7))
      throw CLI::ValidationError("--outage", "expected FROM:UNTIL in seconds, got '" + text + "'");
    capacity->AddOutage(FromSeconds(from), FromSeconds(until));
  }
}

void ApplyWay(const Text::Way& w, double propagation_ms, link::BottleneckConfig* config) {
  config->loss = w.loss_percent / 100;
  config->delay = Ms(propagation_ms + w.extra_delay_ms);
  config->path = {Ms(w.jitter_ms), Ms(w.burst_ms), w.reorder_percent / 100, Ms(w.reorder_delay_ms),
                  w.duplicate_percent / 100};
}

void Apply(const Text& t, LinkOptions* o) {
  o->there.capacity = ReadCapacity(t);
  AddOutages(t, &o->there.capacity);
  o->there.limit.bytes = DataSize::Bytes(t.queue_bytes > 0 ? t.queue_bytes : 16 << 20);
  if (t.queue_ms > 0) o->there.limit.time = Ms(t.queue_ms);
  o->there.aqm = {t.aqm, Ms(t.aqm_low_ms), Ms(t.aqm_high_ms), {}};
  if (t.aqm == Kind::kRamp && t.aqm_low_ms > t.aqm_high_ms)
    throw CLI::ValidationError("--aqm-low", "must not be above --aqm-high");
  o->there.aqm.pi2.target = Ms(t.aqm_target_ms);
  if (t.aqm_classic && t.aqm != Kind::kPi2)
    throw CLI::ValidationError("--aqm-classic", "needs --aqm pi2");
  o->there.aqm.pi2.knows_l4s = !t.aqm_classic;
  ApplyWay(t.there, t.rtt_ms / 2, &o->there);
  ApplyWay(t.back, t.rtt_ms / 2, &o->back);
  o->there.seed = t.seed;
  o->back.seed = t.seed + 1000;
  if (t.duration_s > 0) o->duration = FromSeconds(t.duration_s);
  o->interval = FromSeconds(t.interval_s);
}

void AddProgramOptions(CLI::App* app, Text* t, LinkOptions* o) {
  app->add_option("--listen", o->listen, "Where senders send to, [HOST:]PORT; repeatable")
      ->capture_default_str();
  app->add_option("--forward", o->forward, "The receiver's HOST:PORT, one for each --listen")
      ->capture_default_str();
  app->add_flag("--bleach", o->bleach, "Clear the ECN bits, as some networks do");
  app->add_option("--overhead", o->overhead_bytes, "Bytes added to each UDP payload (IP and UDP)")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1000}))
      ->capture_default_str();
  app->add_flag("--start-now", o->origin_at_start,
                "The capacity's time starts with the program, not with the first packet");
  app->add_option("--log", o->log, "CSV file, one line a packet");
  app->add_option("--summary", o->summary, "JSON file with the totals; '-': standard output");
  app->add_option("--duration", t->duration_s, "Stop this long after the first packet [s]")
      ->check(CLI::Range(0.0, 1e7));
  app->add_option("--interval", t->interval_s, "Time between live lines [s]")
      ->check(CLI::Range(0.01, 3600.0));
  app->add_flag("--json-lines", o->json_lines, "Live lines as JSON on standard output");
  app->add_flag("--quiet", o->quiet, "No live lines");
}

}  // namespace

LinkOptions ParseLinkOptions(int argc, char** argv) {
  CLI::App app{
      "lidar-link: a UDP relay that is a bottleneck link.\n"
      "Packets to --listen queue before a link of the given capacity and go on to --forward with\n"
      "their ECN bits, or CE where the queue marks them; what the receiver answers goes back to\n"
      "the sender. Every sender address is a flow of its own; all share the bottleneck.\n",
      "lidar-link"};
  AddVersionFlag(&app, "lidar-link");
  app.footer(
      "Example: a 5G-like link between screamsink port=5004 and screamsrc port=5006\n"
      "  lidar-link --listen 5004 --forward 127.0.0.1:5006 --steps 12,6,9 --rtt 40 --aqm ramp");
  Text text;
  LinkOptions options;
  AddProgramOptions(&app, &text, &options);
  AddLinkOptions(&app, &text);
  Parse(&app, argc, argv, [&] {
    Apply(text, &options);
    if (options.listen.size() != options.forward.size())
      throw CLI::ValidationError("--forward", "must be given once for each --listen");
  });
  return options;
}

}  // namespace lidar::tools
