// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/sim/loop_case.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "src/link/gaps.h"
#include "src/link/trace_maker.h"
#include "src/sim/simulated_time.h"

namespace lidar::loop {
namespace {

using namespace std::chrono_literals;
using scream::test::FrameLog;
using scream::test::PacketLog;
using scream::test::SimulationResult;

constexpr Duration kSettle = 3s;
constexpr Duration kBin = 100ms;
constexpr double kFramesPerSecond = 50;
constexpr DataRate kCameraMin = DataRate::BitsPerSecond(0.3e6);
constexpr DataRate kCameraMax = DataRate::BitsPerSecond(4e6);

scream::test::SourceConfig Camera() {
  scream::test::SourceConfig camera;
  camera.frames_per_second = 30;
  camera.stream.min_bitrate = camera.stream.needed_bitrate = kCameraMin;
  camera.stream.start_bitrate = camera.stream.max_bitrate = kCameraMax;
  return camera;
}

scream::test::SimulationConfig ConfigOf(const LoopCase& c, LoopSource* source) {
  scream::test::SimulationConfig config;
  config.forward.origin = kStart;
  config.forward.capacity = c.capacity;
  config.forward.delay = c.rtt / 2;
  config.forward.aqm.kind = c.aqm;
  config.forward.limit = c.limit;
  config.return_delay = c.rtt / 2;
  config.duration = c.duration;
  scream::test::FlowConfig& flow = config.flows.front();
  flow.parameters = c.parameters;
  flow.start = kStart;
  scream::test::SourceConfig& media = flow.sources.front();
  media.stream.start_bitrate = DataRate::BitsPerSecond(4e6);
  media.stream.max_bitrate = DataRate::BitsPerSecond(100e6);
  media.frames_per_second = kFramesPerSecond;
  if (c.frames) return config;
  media.frames_per_second = c.source.scans_per_second * c.source.slices;
  media.encoder = [source](DataRate target) { return source->Next(target); };
  if (c.camera) {
    media.stream.priority = 2;
    flow.sources.push_back(Camera());
  }
  return config;
}

/// Returns the highest rate of the source, including the camera.
DataRate SourceMax(const LoopCase& c, const LoopReport& report) {
  if (c.frames) return DataRate::Infinite();
  return DataRate::BitsPerSecond(report.max_mbps * 1e6) + (c.camera ? kCameraMax : DataRate());
}

/// Returns the bits that the link can carry and the source can use in the time `length` after
/// `from`.
double Usable(const LoopCase& c, const LoopReport& report, Duration from, Duration length) {
  const double link = c.capacity.Between(from, from + length).bits();
  return std::min(link, SourceMax(c, report).bits_per_second() * Seconds(length));
}

void CountScans(const LoopCase& c, const SimulationResult& result, LoopReport* report) {
  std::vector<FrameLog> frames;  // slices or frames of the LiDAR
  for (const FrameLog& f : result.flows.front().frames)
    if (f.source == 0) frames.push_back(f);
  const std::size_t slices = c.frames ? 1 : c.source.slices;
  const Duration max_age = link::OracleConfig{}.max_age;
  std::vector<double> latency_ms;
  std::int64_t bytes = 0;
  for (std::size_t i = 0; i + slices <= frames.size(); i += slices) {
    std::size_t complete = 0;
    std::size_t left_out = 0;
    std::size_t in_time = 0;
    for (std::size_t k = i; k < i + slices; ++k) {
      const FrameLog& f = frames[k];
      bytes += f.bytes;
      left_out += f.bytes == 0;
      complete += f.complete();
      if (!f.complete()) continue;
      latency_ms.push_back(Milliseconds(f.arrival - f.created));
      in_time += f.arrival - f.created <= max_age;
    }
    ++report->captured;
    report->skipped += left_out > 0;
    report->complete += complete == slices;
    report->in_time += in_time == slices;
  }
  report->encoded_mbps = static_cast<double>(bytes) * 8 / 1e6 / Seconds(c.duration);
  report->capture_to_cloud_ms = scream::test::Summarise(std::move(latency_ms));
}

void AskOracles(const LoopCase& c, LoopReport* report) {
  link::OracleConfig oracle;
  oracle.duration = c.duration;
  oracle.rtt = c.rtt;
  oracle.slices_per_scan = c.source.slices;
  oracle.scans_per_second = c.source.scans_per_second;
  oracle.rate = DataRate::BitsPerSecond(report->min_mbps * 1e6);
  report->oracle_at_min = AskOracle(c.capacity, oracle);
  oracle.rate = DataRate::BitsPerSecond(report->encoded_mbps * 1e6);
  report->oracle_at_mean = AskOracle(c.capacity, oracle);
}

/// Returns the delivered bits relative to the usable bits, which are summed over bins of kBin.
double Utilisation(const LoopCase& c, const SimulationResult& result, const LoopReport& report) {
  double used = 0, usable = 0;
  for (Duration t = kSettle; t + kBin <= c.duration; t += kBin)
    usable += Usable(c, report, t, kBin);
  const Duration delay = c.rtt / 2;
  used = static_cast<double>(
      result.DeliveredBytes(kStart + kSettle + delay, kStart + c.duration + delay) * 8);
  return used / usable;
}

void MeasureRecovery(const LoopCase& c, const SimulationResult& result, LoopReport* report) {
  std::vector<link::SentPacket> sent;
  for (const PacketLog& p : result.packets)
    sent.push_back({p.sent - kStart, DataSize::Bytes(p.bytes)});
  auto times = RecoveryAfterGaps(c.capacity, sent, {c.duration, SourceMax(c, *report)});
  report->gaps = times.size();
  report->recovery_s = scream::test::Summarise(std::move(times));
}

void MeasureNetwork(const LoopCase& c, const SimulationResult& result, LoopReport* report) {
  report->queue_ms = result.QueueDelay(kStart + kSettle, kStart + c.duration);
  const auto& flow = result.flows.front();
  report->own_loss = static_cast<double>(flow.packets_congestion_lost) /
                     static_cast<double>(std::max<std::uint64_t>(1, flow.packets_sent));
  report->utilisation = Utilisation(c, result, *report);
  MeasureRecovery(c, result, report);
}

link::Capacity Parse(const std::string& text) {
  std::string error;
  return *link::Capacity::ParseTrace(text, true, &error);
}

NamedTrace Gaps(const char* name, Duration gap, Duration every) {
  link::GapTraceConfig config;
  config.gap = gap;
  config.every = every;
  return {name, Parse(MakeGapTrace(config))};
}

NamedTrace Drive(std::uint64_t seed, double mbps) {
  link::DriveTraceConfig config;
  config.seed = seed;
  config.mean = DataRate::BitsPerSecond(mbps * 1e6);
  return {"drive_" + std::to_string(seed), Parse(MakeDriveTrace(config))};
}

}  // namespace

LoopRun RunLoop(const LoopCase& c) {
  LoopSource source(c.source);
  LoopRun run;
  run.simulation = Simulate(ConfigOf(c, &source));
  run.report.min_mbps = source.min().bits_per_second() / 1e6;
  run.report.max_mbps = source.max().bits_per_second() / 1e6;
  CountScans(c, run.simulation, &run.report);
  if (!c.frames) AskOracles(c, &run.report);
  MeasureNetwork(c, run.simulation, &run.report);
  return run;
}

LoopCase Later(LoopCase c, int n) {
  constexpr Duration kApart = 7330ms;
  c.capacity = c.capacity.StartingAt(kApart * n);
  c.source.seed += static_cast<unsigned>(n);
  return c;
}

std::vector<NamedTrace> BuiltInTraces() {
  return {Gaps("gap_100ms_every_0.6s", 100ms, 600ms),
          Gaps("gap_100ms_every_2s", 100ms, 2s),
          Gaps("gap_1s_every_10s", 1s, 10s),
          Drive(1, 8),
          Drive(2, 5),
          Drive(3, 12)};
}

std::optional<NamedTrace> ReadTrace(const std::string& path, std::string* error) {
  std::stringstream text;
  std::ifstream file(path);
  if (!file) {
    *error = "cannot read " + path;
    return std::nullopt;
  }
  text << file.rdbuf();
  const auto capacity = link::Capacity::ParseTrace(text.str(), true, error);
  if (!capacity) return std::nullopt;
  const std::size_t slash = path.find_last_of('/');
  const std::string name = slash == std::string::npos ? path : path.substr(slash + 1);
  return NamedTrace{name.substr(0, name.rfind('.')), *capacity};
}

}  // namespace lidar::loop
