// SPDX-License-Identifier: LGPL-2.1-or-later
// Compares the report of a fixed run of the demo, and the effect of each option, with golden files.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "src/tools/bench/demo/measurements.h"
#include "src/tools/bench/demo/report.h"
#include "src/tools/bench/demo/summary.h"
#include "src/tools/bench/demo/verdict.h"
#include "src/tools/bench/lidar_link/options.h"
#include "src/tools/bench/scream_bench/options.h"
#include "tests/support/golden_lines.h"

namespace lidar::demo {
namespace {
using test::Line;
using test::Lines;

constexpr std::int64_t kMilli = 1'000'000;
constexpr std::int64_t kFrom = 1'700'000'000'000 * kMilli;

/// Returns measurements of 6 s with 10 scans per second and two slices per scan. One slice in 9 is
/// lost, and one scan in 13 is skipped.
Measurements FixedRun(std::size_t links) {
  Measurements m;
  m.options.duration_s = 6;
  m.options.steps_mbps = {8, 4};
  m.options.links = links;
  m.origin_unix_ns = kFrom;
  m.ran_s = 6;
  for (std::uint32_t scan = 0; scan < 60; ++scan)
    for (std::uint32_t slice = 0; slice < 2; ++slice) {
      const std::int64_t at = kFrom + (100 * scan + 50 * slice) * kMilli;
      const auto record = [&](const char* type, std::int64_t after_ms, std::int64_t took_ms) {
        m.ledger.Add({{"type", type},
                      {"scan", scan},
                      {"slice", slice},
                      {"count", 2},
                      {"unix_ns", at + after_ms * kMilli},
                      {"due_ns", at - 5 * kMilli},
                      {"took_ns", took_ms * kMilli},
                      {"bytes", 900 + 10 * scan},
                      {"returns", 500 + scan}});
      };
      record("captured", 0, 0);
      if (scan % 13 == 12) continue;
      record("encoded", 4, 3);
      if ((2 * scan + slice) % 9 == 8) continue;
      record("received", 25 + scan, 0);
      record("decoded", 30 + scan, 2);
      m.ledger.Add(SliceKey{scan, slice}, Comparison{500, 1, 2, 0.01 + 0.0005 * scan, 4});
      if (slice == 1) record("posed", 45 + scan, 0);
    }
  for (int i = 0; i < 600; ++i)
    m.packets.push_back({0.01 * i, 1000 + i, i % 20 != 0, i % 7 == 0, 1.0 + i % 40,
                         static_cast<std::size_t>(i) % links});
  for (int i = 0; i < 60; ++i)
    m.samples.push_back(ReadSample({{"type", "stats"},
                                    {"unix_ns", kFrom + 100 * i * kMilli},
                                    {"sender",
                                     {{"target-bitrate", 1000000 + i},
                                      {"estimated-capacity", 2000000 + i},
                                      {"rtt", 40000000 + i * kMilli},
                                      {"queue-delay", 3 * kMilli + i},
                                      {"ref-wnd", 5000 + i},
                                      {"bytes-in-flight", 4000 + i},
                                      {"sender-queue-delay", 7 * kMilli},
                                      {"packets-dropped", i / 20}}},
                                    {"encoder", {{"quantization-step", 0.02 + 0.001 * i}}}}));
  m.AddBounds(kFrom, 1e6, 6e6);
  m.AddBounds(kFrom + 2000 * kMilli, 2e6, 5e6);
  m.EndBounds(kFrom + 6000 * kMilli);
  m.sender_stats = {
      {"packets-sent", 600}, {"packets-lost", 30}, {"links", nlohmann::json::array()}};
  return m;
}

void AddFile(const std::string& path, Lines* lines) {
  std::ifstream file(path);
  lines->push_back("- " + std::filesystem::path(path).filename().string());
  std::string line;
  for (int n = 0; std::getline(file, line); ++n)
    if (n == 0 || n % 10 == 3) lines->push_back(line);
}

void AddJson(const nlohmann::ordered_json& json, const std::string& name, Lines* lines) {
  if (json.is_structured()) {
    for (const auto& item : json.items()) AddJson(item.value(), name + "/" + item.key(), lines);
  } else if (json.is_number_float()) {
    lines->push_back(Line(name, " ", json.get<double>()));
  } else {
    lines->push_back(name + " " + json.dump());
  }
}

TEST(ToolsGolden, Report) {
  Lines lines;
  const std::string folder = testing::TempDir() + "golden_report";
  std::filesystem::create_directories(folder);
  for (const std::size_t links : {std::size_t{1}, std::size_t{2}}) {
    const Measurements m = FixedRun(links);
    lines.push_back(Line("- links ", links));
    const auto summary = Summarise(m);
    AddJson(summary, "", &lines);
    WriteTables(m, folder);
    for (const char* file : {"timeline.csv", "slices.csv"}) AddFile(folder + "/" + file, &lines);
    testing::internal::CaptureStdout();
    PrintTable(summary);
    std::istringstream table(testing::internal::GetCapturedStdout());
    for (std::string line; std::getline(table, line);) lines.push_back(line);
    for (const Guarantee& g : CheckGuarantees(m))
      lines.push_back((g.holds ? "holds: " : "broken: ") + g.text);
    for (const Transient& t : FindTransients(m))
      lines.push_back(Line("at ", t.at_s, " from ", t.from_bps, " to ", t.to_bps, " peak ",
                           t.peak_ms, " settled ", t.settled_after_s));
    const Verdict v = Judge(m);
    lines.push_back(Line(static_cast<int>(v.level), " ", v.text));
    lines.insert(lines.end(), v.hints.begin(), v.hints.end());
  }
  RemoveReport(folder);
  lines.push_back(std::filesystem::is_empty(folder) ? "removed" : "files are left");
  test::ExpectGoldenLines(lines, GOLDEN_FOLDER "/report.txt");
}

template <class Parse>
auto Parsed(Parse parse, std::vector<std::string> words) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  return parse(static_cast<int>(argv.size()), argv.data());
}

TEST(ToolsGolden, OptionsOfTheLink) {
  Lines lines;
  const auto note = [&](const std::vector<std::string>& words) {
    std::string all;
    for (const std::string& word : words) all += " " + word;
    lines.push_back("-" + all);
    const tools::LinkOptions o = Parsed(tools::ParseLinkOptions, words);
    lines.push_back(Line(o.listen.front(), " ", o.forward.front(), " ", o.listen.size(), " start ",
                         o.origin_at_start, " bleach ", o.bleach, " overhead ", o.overhead_bytes,
                         " log ", o.log, " summary ", o.summary, " duration ", Seconds(o.duration),
                         " interval ", Seconds(o.interval), " json ", o.json_lines, " quiet ",
                         o.quiet));
    for (const link::BottleneckConfig* c : {&o.there, &o.back}) {
      std::string rates;
      for (int s : {0, 5, 10, 15, 25, 45})
        rates += Line(" ", c->capacity.RateAt(std::chrono::seconds(s)).bits_per_second());
      lines.push_back("rates" + rates);
      lines.push_back(Line("limit ", c->limit.bytes.bytes(), " ", Seconds(c->limit.time), " aqm ",
                           static_cast<int>(c->aqm.kind), " ", Seconds(c->aqm.low), " ",
                           Seconds(c->aqm.high), " pi2 ", Seconds(c->aqm.pi2.target), " ",
                           c->aqm.pi2.knows_l4s, " loss ", c->loss, " delay ", Seconds(c->delay),
                           " path ", Seconds(c->path.jitter), " ", Seconds(c->path.burst_interval),
                           " ", c->path.reorder, " ", Seconds(c->path.reorder_delay), " ",
                           c->path.duplicate, " ", c->path.jitter_draws, " seed ", c->seed));
    }
  };
  note({"lidar-link"});
  note({"lidar-link", "--listen",     "1",          "2",          "--forward",   "3",
        "4",          "--bleach",     "--overhead", "5",          "--start-now", "--log",
        "l",          "--summary",    "s",          "--duration", "6",           "--interval",
        "7",          "--json-lines", "--quiet"});
  note({"lidar-link",
        "--steps",
        "8,9",
        "--step-time",
        "11",
        "--outage",
        "3:12",
        "--rtt",
        "10",
        "--queue",
        "11",
        "--queue-bytes",
        "12",
        "--aqm",
        "PI2",
        "--aqm-low",
        "1",
        "--aqm-high",
        "13",
        "--aqm-target",
        "14",
        "--aqm-classic",
        "--loss",
        "15",
        "--delay",
        "16",
        "--jitter",
        "17",
        "--burst",
        "18",
        "--reorder",
        "19",
        "--reorder-delay",
        "20",
        "--duplicate",
        "21",
        "--seed",
        "22"});
  note({"lidar-link",
        "--steps",
        "8,9",
        "--once",
        "--aqm",
        "dualpi2",
        "--back-loss",
        "15",
        "--back-delay",
        "16",
        "--back-jitter",
        "17",
        "--back-burst",
        "18",
        "--back-reorder",
        "19",
        "--back-reorder-delay",
        "20",
        "--back-duplicate",
        "21"});
  note({"lidar-link", "--rate", "3", "--aqm", "none"});
  test::ExpectGoldenLines(lines, GOLDEN_FOLDER "/link_options.txt");
}

TEST(ToolsGolden, OptionsOfTheBench) {
  Lines lines;
  const auto note = [&](const std::vector<std::string>& words) {
    const tools::BenchOptions o = Parsed(tools::ParseBenchOptions, words);
    const auto& t = o.tx;
    const auto& r = o.rx;
    lines.push_back(Line("tx ", o.is_sender, " ", t.host, ":", t.port, " from ", t.bind_address,
                         ":", t.bind_port, " fps ", t.fps, " init ",
                         t.init_bitrate.bits_per_second(), " min ", t.min_bitrate.bits_per_second(),
                         " max ", t.max_bitrate.bits_per_second(), " ecn ", t.ecn, " jitter ",
                         t.frame_jitter_percent, " mtu ", t.mtu, " log ", t.log, " rx ", r.port,
                         " ", r.address, " to ", r.feedback, " ", r.num_reports, " ", r.log,
                         " duration ", Seconds(o.duration), " summary ", o.summary));
  };
  note({"scream-bench", "tx", "--host", "h", "--port", "1"});
  note({"scream-bench",  "tx", "--host",     "h",   "--port",         "1",  "--bind-address", "b",
        "--bind-port",   "2",  "--fps",      "3",   "--init-bitrate", "4k", "--min-bitrate",  "5",
        "--max-bitrate", "3G", "--ecn",      "off", "--frame-jitter", "7",  "--mtu",          "800",
        "--log",         "l",  "--duration", "8",   "--summary",      "s"});
  note({"scream-bench", "rx", "--port", "1"});
  note({"scream-bench", "rx", "--port", "1", "--address", "a", "--feedback", "f", "--num-reports",
        "ericsson", "--log", "l", "--duration", "8", "--summary", "s"});
  test::ExpectGoldenLines(lines, GOLDEN_FOLDER "/bench_options.txt");
}

TEST(ToolsGolden, OptionsOfTheDemo) {
  Lines lines;
  const auto note = [&](std::vector<std::string> words) {
    std::string all;
    for (const std::string& word : words) all += " " + word;
    lines.push_back("-" + all);
    CLI::App app;
    RunOptions o;
    AddRunOptions(&app, &o);
    std::reverse(words.begin(), words.end());
    try {
      app.parse(words);
      CheckRunOptions(o);
    } catch (const CLI::ParseError& e) {
      lines.push_back(Line("refused: ", e.what()));
      return;
    }
    Ports ports;
    ports.receiver = 1;
    for (std::size_t i = 0; i < o.links; ++i) ports.links.push_back(static_cast<int>(2 + i));
    lines.push_back(SenderPipeline(o, ports));
    lines.push_back(ReceiverPipeline(o, ports));
    std::string link;
    for (const std::string& word : LinkArguments(o, ports, o.links - 1)) link += word + " ";
    lines.push_back(Line(link, "| bound ", ErrorBoundOf(o), " step ", FixedStepOf(o), " changes ",
                         ChangesOf(o).size(), " duration ", o.duration_s, " plots ", o.plots));
  };
  note({});
  note({"--duration", "9", "--output", "out", "--view", "--slam"});
  note({"--no-plots", "--slam", "--model", "vlp-16", "--scene", "field", "--speed", "3", "--seed",
        "4", "--slices", "5"});
  note({"--geometry", "xyz", "--max-error", "0.03", "--max-bitrate", "7", "--start-bitrate", "2",
        "--rate", "8", "--rtt", "9", "--loss", "1", "--no-l4s"});
  note({"--links", "2", "--drive", "--secure", "--fixed-step", "0.2"});
  note({"--fixed-bits", "12", "--encoder", "dracoenc", "--steps", "1,2,3"});
  note({"--geometry", "xyz", "--encoder", "lidarenc"});
  note({"--start-bitrate", "9", "--max-bitrate", "8"});
  test::ExpectGoldenLines(lines, GOLDEN_FOLDER "/demo_options.txt");
}

}  // namespace
}  // namespace lidar::demo
