// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/core/scream/scenarios.h"

#include <algorithm>

namespace lidar::scream::test {
namespace {

using link::AqmConfig;
using link::Capacity;

constexpr Time kOrigin{std::chrono::seconds(100)};
constexpr double kSlicesPerScan = 8;
constexpr double kSliceJitter = 0.1;

DataRate Mbps(double r) { return DataRate::BitsPerSecond(r * 1e6); }

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
  s.config.forward.origin = kOrigin;
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
  flow.start = kOrigin;
  flow.sources[0].stream.max_bitrate = Mbps(60);
  return s;
}

Scenario WithSlices(Scenario s) {
  s.name += "-slices";
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
    // The first time that the queue stays below 10 ms for 0.2 s.
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
  const std::size_t ours = result.flows.size(), theirs = result.others.size();
  for (std::size_t i = 0; i < ours; ++i) m.ours_mbps += mbps(i) / static_cast<double>(ours);
  for (std::size_t i = 0; i < theirs; ++i) {
    const TcpResult& t = result.others[i];
    m.theirs_mbps += mbps(ours + i) / static_cast<double>(theirs);
    m.their_loss += static_cast<double>(t.packets_lost) /
                    static_cast<double>(std::max<std::uint64_t>(1, t.packets_sent)) /
                    static_cast<double>(theirs);
  }
  return m;
}

Capacity Constant(double mbps) { return Capacity::Constant(Mbps(mbps)); }

/// What paths beyond the usual ones do.
std::vector<Scenario> PathScenarios(const Path& a, const Path& c, const Parameters& p) {
  std::vector<Scenario> all;
  Path step = c;
  step.aqm = AqmConfig::Kind::kStep;
  all.push_back(Make("S", "C with a step at 1 ms", step, 50, p));
  all.back().config.forward.aqm.high = 1ms;
  all.push_back(Make("A-jitter", "A with 4 ms of jitter", a, 50, p));
  all.back().config.forward.path.jitter = 4ms;
  all.push_back(Make("A-bursts", "A, packets come out every 5 ms", a, 50, p));
  all.back().config.forward.path.burst_interval = 5ms;
  all.push_back(Make("A-reorder", "A, 1 % of the packets 5 ms late", a, 50, p));
  all.back().config.forward.path.reorder = 0.01;
  all.push_back(Make("A-dualpi2", "A with DualPI2", a, 50, p));
  all.back().config.forward.aqm.kind = AqmConfig::Kind::kDualPi2;
  all.push_back(Make("A-longer", "A, 15 ms longer from 15 s on", a, 50, p));
  all.back().config.longer_by = 15ms;
  all.back().config.longer_from = 15s;
  return all;
}

}  // namespace

std::vector<Scenario> Scenarios(const Parameters& p) {
  const auto steps = Capacity::Steps(
      {Mbps(12), Mbps(4), Mbps(8), Mbps(3), Mbps(15), Mbps(6), Mbps(10)}, std::chrono::seconds(8));
  Path a{Constant(20), 25ms};
  Path c{Constant(8), 40ms};
  Path d{Constant(8), 40ms, AqmConfig::Kind::kNone, 100ms, 0, Ecn::kNotEct};
  Path e{steps, 40ms};
  e.duration = 56s;
  Path h{Capacity::Steps({Mbps(10), Mbps(3)}, std::chrono::seconds(20)), 40ms};
  Path k{Constant(8), 40ms, AqmConfig::Kind::kNone, 10ms, 0, Ecn::kNotEct};
  std::vector<Scenario> all;
  all.push_back(Make("A", "20 Mbit/s, RTT 25, ramp 2-10 ms", a, 50, p));
  all.push_back(WithSlices(all.back()));
  all.push_back(Make("C", "8 Mbit/s, RTT 40, ramp", c, 50, p));
  all.push_back(Make("C10", "C at 10 frames/s", c, 10, p));
  all.push_back(WithSlices(all.back()));
  all.push_back(Make("D", "8 Mbit/s, Not-ECT, FIFO 100 ms", d, 50, p));
  all.push_back(WithSlices(all.back()));
  all.push_back(Make("E", "steps 12,4,8,3,15,6,10 every 8 s, ramp", e, 50, p));
  all.push_back(Make("E10", "E at 10 frames/s", e, 10, p));
  all.push_back(WithSlices(all.back()));
  for (const double percent : {0.5, 1.0, 2.0}) {
    Path g = a;
    g.loss = percent / 100;
    const std::string text = std::to_string(percent).substr(0, 3);
    all.push_back(Make("G" + text, "A with " + text + " % random loss", g, 50, p));
  }
  all.push_back(Make("H", "10 -> 3 Mbit/s at 20 s, ramp", h, 50, p));
  all.push_back(WithSlices(all.back()));
  Scenario j = Make("J", "two flows on 20 Mbit/s, ramp", a, 50, p);
  j.config.flows.push_back(j.config.flows.front());
  j.config.flows.back().start += 5s;
  j.settle = 15s;
  all.push_back(j);
  all.push_back(Make("K", "8 Mbit/s, RTT 40, Not-ECT, FIFO 10 ms", k, 50, p));
  all.push_back(WithSlices(all.back()));
  d.ecn = k.ecn = Ecn::kEct1;
  all.push_back(Make("D-ect1", "D with ECT(1), which nobody marks", d, 50, p));
  all.push_back(Make("K-ect1", "K with ECT(1), which nobody marks", k, 50, p));
  for (const Scenario& s : PathScenarios(a, c, p)) all.push_back(s);
  for (const Scenario& s : BesideScenarios(p)) all.push_back(s);
  for (Scenario& s : all) {
    if (s.name[0] == 'H') s.drop_at = 20s;
    if (s.name[0] == 'E') s.settle = 0s;
  }
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
  if (!result.others.empty()) m.beside = MeasureBeside(s, result);
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
