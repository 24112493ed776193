// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/sim/scenarios.h"

#include <algorithm>
#include <cstdlib>

#include "src/sim/simulated_time.h"

namespace lidar::scream::test {
namespace {

using link::AqmConfig;
using link::Capacity;

constexpr double kSlicesPerScan = 8;
constexpr double kSliceJitter = 0.1;

struct Path {
  Capacity capacity = Capacity::Constant(DataRate::Infinite());
  Duration rtt{0};
  AqmConfig::Kind aqm = AqmConfig::Kind::kRamp;
  Duration limit = Duration::max();
  double loss = 0;
  Ecn ecn = Ecn::kEct1;
  Duration duration = std::chrono::seconds(40);
};

Scenario Make(const std::string& name, const std::string& description, const Path& path,
              double frames_per_second, const Parameters& parameters) {
  Scenario s;
  s.name = name;
  s.description = description;
  s.frames_per_second = frames_per_second;
  s.config.forward.origin = kStart;
  s.config.forward.capacity = path.capacity;
  s.config.forward.delay = path.rtt / 2;
  s.config.forward.aqm.kind = path.aqm;
  s.config.forward.limit.time = path.limit;
  s.config.forward.loss = path.loss;
  s.config.return_delay = path.rtt / 2;
  s.config.duration = path.duration;
  FlowConfig& flow = s.config.flows.front();
  flow.parameters = parameters;
  flow.parameters.ecn = path.ecn;
  flow.sources[0].frames_per_second = frames_per_second;
  flow.start = kStart;
  flow.sources[0].stream.max_bitrate = Mbps(60);
  return s;
}

/// Returns the same scenario with slices instead of frames. The first part of its `name` is the
/// kind of source.
Scenario WithSlices(Scenario s) {
  s.name = "slices" + s.name.substr(s.name.find('_'));
  s.description = "slices: " + s.description;
  s.source = Source::kSlices;
  for (FlowConfig& flow : s.config.flows) {
    flow.sources[0].frames_per_second = 10 * kSlicesPerScan;
    flow.sources[0].frame_jitter = kSliceJitter;
  }
  return s;
}

DropMetrics MeasureDrop(Time drop, double capacity_mbps, const SimulationResult& result) {
  DropMetrics m;
  Time high = drop;
  for (const PacketLog& p : result.packets) {
    if (!p.delivered || p.arrival < drop || p.arrival > drop + std::chrono::seconds(5)) continue;
    m.peak_queue_ms = std::max(m.peak_queue_ms, p.sojourn_ms);
    // Finds the first time after which the queue stays below 10 ms for 0.2 s.
    if (p.sojourn_ms >= 10 && (high == drop || p.arrival - high < std::chrono::milliseconds(200)))
      high = p.arrival;
  }
  m.recovered_s = Seconds(high - drop);
  constexpr Duration kWindow = std::chrono::milliseconds(50);
  for (Duration t{0}; t < std::chrono::seconds(5); t += std::chrono::milliseconds(5)) {
    std::int64_t bytes = 0;
    for (const PacketLog& p : result.packets)
      if (p.sent >= drop + t && p.sent < drop + t + kWindow) bytes += p.bytes;
    m.below_rate_s = Seconds(t);
    if (static_cast<double>(bytes) * 8 / Seconds(kWindow) < capacity_mbps * 1e6) break;
  }
  return m;
}

BesideMetrics MeasureBeside(const Scenario& s, const SimulationResult& result) {
  BesideMetrics m;
  const Time from = s.config.forward.origin + s.settle;
  const Time until = s.config.forward.origin + s.config.duration;
  const auto mbps = [&](std::size_t flow) {
    return static_cast<double>(result.DeliveredBytes(from, until, static_cast<int>(flow))) * 8 /
           1e6 / Seconds(until - from);
  };
  const std::size_t ours = s.beside_draft ? 1 : result.flows.size();
  const std::size_t all = result.flows.size() + result.others.size();
  for (std::size_t i = 0; i < ours; ++i) m.ours_mbps += mbps(i) / static_cast<double>(ours);
  for (std::size_t i = ours; i < all; ++i)
    m.theirs_mbps += mbps(i) / static_cast<double>(all - ours);
  for (const TcpResult& t : result.others)
    m.their_loss += static_cast<double>(t.packets_lost) /
                    static_cast<double>(std::max<std::uint64_t>(1, t.packets_sent)) /
                    static_cast<double>(all - ours);
  return m;
}

Capacity Constant(double mbps) { return Capacity::Constant(Mbps(mbps)); }

/// Returns scenarios of paths that reorder, delay or lose packets.
std::vector<Scenario> PathScenarios(const Path& fast, const Path& slow, const Parameters& p) {
  std::vector<Scenario> all;
  Path step = slow;
  step.aqm = AqmConfig::Kind::kStep;
  all.push_back(Make("frames_8M_step1ms", "8 Mbit/s, RTT 40, step at 1 ms", step, 50, p));
  all.back().config.forward.aqm.high = 1ms;
  all.push_back(WithSlices(all.back()));
  all.push_back(Make("frames_20M_jitter4", "20 Mbit/s, 4 ms of jitter", fast, 50, p));
  all.back().config.forward.path.jitter = 4ms;
  all.push_back(Make("frames_20M_bursts5", "20 Mbit/s, packets come out every 5 ms", fast, 50, p));
  all.back().config.forward.path.burst_interval = 5ms;
  all.push_back(
      Make("frames_20M_reorder1", "20 Mbit/s, 1 % of the packets 5 ms late", fast, 50, p));
  all.back().config.forward.path.reorder = 0.01;
  all.push_back(Make("frames_20M_dualpi2", "20 Mbit/s, DualPI2", fast, 50, p));
  all.back().config.forward.aqm.kind = AqmConfig::Kind::kDualPi2;
  all.push_back(WithSlices(all.back()));
  all.push_back(
      Make("frames_20M_longer_route", "20 Mbit/s, 15 ms longer from 15 s on", fast, 50, p));
  all.back().config.longer_by = 15ms;
  all.back().config.longer_from = 15s;
  return all;
}

/// Returns scenarios in which the capacity changes.
std::vector<Scenario> ChangingScenarios(const Parameters& p) {
  std::vector<Scenario> all;
  const auto steps = Capacity::Steps(
      {Mbps(12), Mbps(4), Mbps(8), Mbps(3), Mbps(15), Mbps(6), Mbps(10)}, std::chrono::seconds(8));
  Path path{steps, 40ms};
  path.duration = 56s;
  const std::string text = "12, 4, 8, 3, 15, 6, 10 Mbit/s for 8 s each, ramp";
  all.push_back(Make("frames_steps_rtt40", text, path, 50, p));
  all.push_back(Make("frames10_steps_rtt40", text, path, 10, p));
  all.push_back(WithSlices(all.back()));
  for (Scenario& s : all) s.settle = 0s;
  const Path drop{Capacity::Steps({Mbps(10), Mbps(3)}, std::chrono::seconds(20)), 40ms};
  Scenario s = Make("frames_drop_10M_to_3M", "10 to 3 Mbit/s at 20 s, ramp", drop, 50, p);
  s.drop_at = 20s;
  all.push_back(s);
  all.push_back(WithSlices(s));
  return all;
}

/// Returns scenarios of queues that mark no packets, but drop those for which there is no room.
std::vector<Scenario> FifoScenarios(const Parameters& p) {
  std::vector<Scenario> all;
  for (const Ecn ecn : {Ecn::kNotEct, Ecn::kEct1}) {
    for (const Duration limit : {100ms, 10ms}) {
      const Path path{Constant(8), 40ms, AqmConfig::Kind::kNone, limit, 0, ecn};
      const std::string ms = std::to_string(limit / 1ms);
      const std::string codepoint = ecn == Ecn::kEct1 ? "ect1" : "notect";
      all.push_back(Make("frames_8M_fifo" + ms + "_" + codepoint,
                         "8 Mbit/s, RTT 40, FIFO of " + ms + " ms, " + codepoint, path, 50, p));
      if (ecn == Ecn::kNotEct) all.push_back(WithSlices(all.back()));
    }
  }
  return all;
}

}  // namespace

std::vector<Scenario> Scenarios(const Parameters& p) {
  const Path fast{Constant(20), 25ms};
  const Path slow{Constant(8), 40ms};
  std::vector<Scenario> all;
  all.push_back(Make("frames_20M_rtt25", "20 Mbit/s, RTT 25, ramp 2-10 ms", fast, 50, p));
  all.push_back(WithSlices(all.back()));
  all.push_back(Make("frames_8M_rtt40", "8 Mbit/s, RTT 40, ramp", slow, 50, p));
  all.push_back(Make("frames10_8M_rtt40", "the same at 10 frames/s", slow, 10, p));
  all.push_back(WithSlices(all.back()));
  for (const char* percent : {"0.5", "1.0", "2.0"}) {
    Path lossy = fast;
    lossy.loss = std::atof(percent) / 100;
    all.push_back(Make("frames_20M_loss" + std::string(percent),
                       "20 Mbit/s, " + std::string(percent) + " % random loss", lossy, 50, p));
  }
  Scenario two = Make("frames_20M_two_flows", "two flows on 20 Mbit/s, ramp", fast, 50, p);
  two.config.flows.push_back(two.config.flows.front());
  two.config.flows.back().start += 5s;
  two.settle = 15s;
  all.push_back(two);
  for (const Scenario& s : FifoScenarios(p)) all.push_back(s);
  for (const Scenario& s : ChangingScenarios(p)) all.push_back(s);
  for (const Scenario& s : PathScenarios(fast, slow, p)) all.push_back(s);
  for (const Scenario& s : BesideScenarios(p)) all.push_back(s);
  for (const Scenario& s : EventScenarios(p)) all.push_back(s);
  return all;
}

std::optional<Scenario> FindScenario(const std::string& name, const Parameters& parameters) {
  for (const Scenario& s : Scenarios(parameters))
    if (s.name == name) return s;
  return std::nullopt;
}

ScenarioMetrics Measure(const Scenario& s, const SimulationResult& result) {
  ScenarioMetrics m;
  const Time origin = s.config.forward.origin;
  const Time end = origin + s.config.duration;
  m.utilisation = result.Utilisation(origin + s.settle, end - s.config.forward.delay);
  m.queue_ms = result.QueueDelay(origin + s.settle, end);
  double sum = 0, squares = 0;
  std::vector<double> latencies;
  for (std::size_t i = 0; i < result.flows.size(); ++i) {
    const FlowResult& flow = result.flows[i];
    const double x =
        static_cast<double>(result.DeliveredBytes(origin + s.settle, end, static_cast<int>(i)));
    sum += x;
    squares += x * x;
    latencies.insert(latencies.end(), flow.frame_latency_ms.begin(), flow.frame_latency_ms.end());
    m.own_loss += static_cast<double>(flow.packets_congestion_lost) /
                  static_cast<double>(std::max<std::uint64_t>(1, flow.packets_sent));
    m.frames_dropped += static_cast<double>(flow.frames_dropped);
    m.feedback_kbps +=
        static_cast<double>(flow.feedback_bytes) * 8 / 1e3 / Seconds(s.config.duration);
  }
  for (std::size_t i = 0; i < result.others.size(); ++i) {
    const auto x = static_cast<double>(
        result.DeliveredBytes(origin + s.settle, end, static_cast<int>(result.flows.size() + i)));
    sum += x;
    squares += x * x;
  }
  m.jain = sum * sum / (squares * static_cast<double>(result.flows.size() + result.others.size()));
  if (!result.others.empty() || s.beside_draft) m.beside = MeasureBeside(s, result);
  m.frame_ms = Summarise(std::move(latencies));
  const double capacity = s.config.forward.capacity.RateAt(Duration{0}).bits_per_second();
  const Duration window = 100ms;
  for (Duration t{0}; t < s.config.duration; t += 20ms) {
    m.start_s = Seconds(t + window);
    const std::int64_t bytes = result.DeliveredBytes(origin + t, origin + t + window);
    if (static_cast<double>(bytes) * 8 / Seconds(window) >= 0.9 * capacity) break;
    if (t > 8s) break;
  }
  m.start_peak_ms = result.QueueDelay(origin, origin + 3s).max;
  if (s.drop_at) {
    const double mbps = s.config.forward.capacity.RateAt(*s.drop_at + 1s).bits_per_second() / 1e6;
    m.drop = MeasureDrop(origin + *s.drop_at, mbps, result);
  }
  return m;
}

}  // namespace lidar::scream::test
