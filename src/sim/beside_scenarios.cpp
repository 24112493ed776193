// SPDX-License-Identifier: LGPL-2.1-or-later
// Scenarios of a link that is shared with other flows.
#include <utility>

#include "src/sim/scenarios.h"
#include "src/sim/simulated_time.h"

namespace lidar::scream::test {
namespace {

using link::AqmConfig;

constexpr Duration kRtt = std::chrono::milliseconds(40);
// The other flow starts after ours, so that our model of the link is then outdated.
constexpr Duration kOtherStart = 1s;
constexpr DataSize kShortestFifo = DataSize::Bytes(10 * 1500);

Scenario Beside(const std::string& name, double mbps, TcpKind other, const Parameters& p) {
  Scenario s;
  s.name = name;
  const DataRate capacity = DataRate::BitsPerSecond(mbps * 1e6);
  s.config.forward.origin = kStart;
  s.config.forward.capacity = link::Capacity::Constant(capacity);
  s.config.forward.delay = s.config.return_delay = kRtt / 2;
  s.config.duration = 60s;
  s.config.flows.front().parameters = p;
  s.config.flows.front().start = kStart;
  s.config.flows.front().sources[0].stream.max_bitrate = DataRate::BitsPerSecond(100e6);
  s.config.others = {{other, kOtherStart}};
  s.settle = 20s;
  return s;
}

Scenario BesideOnFifo(TcpKind other, Duration length, double mbps, const Parameters& p) {
  const std::string name = (other == TcpKind::kReno ? "reno_fifo_" : "cubic_fifo_") +
                           std::to_string(length / 1ms) + "ms_" +
                           std::to_string(static_cast<int>(mbps)) + "M";
  Scenario s = Beside(name, mbps, other, p);
  s.config.forward.limit.bytes =
      std::max(kShortestFifo, DataRate::BitsPerSecond(mbps * 1e6) * length);
  return s;
}

Scenario BesideWithAqm(const std::string& name, TcpKind other, AqmConfig::Kind aqm,
                       const Parameters& p, double mbps = 20) {
  Scenario s = Beside(name, mbps, other, p);
  s.config.forward.aqm.kind = aqm;
  return s;
}

/// A scenario in which the other flow runs the draft without extensions, at our frame rate.
Scenario BesideDraft(Duration phase, const Parameters& p) {
  Scenario s = BesideWithAqm("draft_ramp_20M_phase_" + std::to_string(phase / 1ms) + "ms",
                             TcpKind::kCubic, AqmConfig::Kind::kRamp, p);
  s.config.others.clear();
  s.config.forward.delay = s.config.return_delay = 12500us;
  s.config.flows.push_back(s.config.flows.front());
  s.config.flows.back().parameters = Parameters::Draft();
  s.config.flows.back().start += phase;
  s.beside_draft = true;
  return s;
}

/// A scenario with two of our flows, whose frames are `phase` apart.
Scenario AtPhase(Duration phase, const Parameters& p) {
  Scenario s =
      Beside("two_flows_phase_" + std::to_string(phase / 1ms) + "ms", 20, TcpKind::kCubic, p);
  s.config.others.clear();
  s.config.forward.aqm.kind = AqmConfig::Kind::kRamp;
  s.config.forward.delay = s.config.return_delay = 12500us;
  s.config.flows.push_back(s.config.flows.front());
  s.config.flows.back().start += 5s + phase;
  return s;
}

}  // namespace

std::vector<Scenario> BesideScenarios(const Parameters& p) {
  std::vector<Scenario> all;
  // Shorter queues at 8 and 20 Mbit/s would have room for fewer than ten packets.
  const std::pair<Duration, double> fifos[] = {{15ms, 8}, {5ms, 20},  {10ms, 20}, {2ms, 50},
                                               {5ms, 50}, {10ms, 50}, {20ms, 20}, {100ms, 20}};
  for (const auto& [length, mbps] : fifos)
    all.push_back(BesideOnFifo(TcpKind::kCubic, length, mbps, p));
  all.push_back(BesideOnFifo(TcpKind::kReno, 5ms, 20, p));
  all.push_back(BesideWithAqm("cubic_pi2_20M", TcpKind::kCubic, AqmConfig::Kind::kPi2, p));
  all.back().config.forward.aqm.pi2.knows_l4s = false;
  all.push_back(BesideWithAqm("cubic_dualpi2_20M", TcpKind::kCubic, AqmConfig::Kind::kDualPi2, p));
  for (const int mbps : {4, 8, 20})
    all.push_back(BesideWithAqm("prague_ramp_" + std::to_string(mbps) + "M", TcpKind::kPrague,
                                AqmConfig::Kind::kRamp, p, mbps));
  for (const Duration threshold : {1ms, 3ms}) {
    all.push_back(BesideWithAqm("prague_step_" + std::to_string(threshold / 1ms) + "ms_20M",
                                TcpKind::kPrague, AqmConfig::Kind::kStep, p));
    all.back().config.forward.aqm.high = threshold;
  }
  all.push_back(
      BesideWithAqm("prague_dualpi2_20M", TcpKind::kPrague, AqmConfig::Kind::kDualPi2, p));
  for (const Duration phase : {0ms, 4ms, 7ms, 13ms}) all.push_back(BesideDraft(phase, p));
  for (const Duration phase : {4ms, 7ms, 10ms}) all.push_back(AtPhase(phase, p));
  return all;
}

}  // namespace lidar::scream::test
