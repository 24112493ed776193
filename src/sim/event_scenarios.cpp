// SPDX-License-Identifier: LGPL-2.1-or-later
// Scenarios with an event. The measurement begins at the event or shortly after it.
#include "src/sim/scenarios.h"
#include "src/sim/simulated_time.h"

namespace lidar::scream::test {
namespace {

Scenario Event(const std::string& name, double mbps, const Parameters& p) {
  Scenario s;
  s.name = "event_" + name;
  s.config.forward.origin = kStart;
  s.config.forward.capacity = link::Capacity::Constant(Mbps(mbps));
  s.config.forward.delay = s.config.return_delay = 20ms;
  s.config.forward.aqm.kind = link::AqmConfig::Kind::kRamp;
  FlowConfig& flow = s.config.flows.front();
  flow.parameters = p;
  flow.start = kStart;
  flow.sources[0].stream.max_bitrate = Mbps(100);
  s.settle = 15s;
  return s;
}

/// Adds a policer: a queue of 1 ms, which drops all packets above the link's rate.
Scenario Policed(Scenario s) {
  s.config.forward.limit.time = 1ms;
  s.config.forward.aqm.kind = link::AqmConfig::Kind::kNone;
  return s;
}

/// A scenario in which a burst of losses looks like a policer, before the link becomes faster.
Scenario PolicerLifted(const Parameters& p) {
  Scenario s = Event("policer_lifted", 10, p);
  s.config.forward.capacity = *link::Capacity::ParseTrace("0 10\n20 80\n", false, nullptr);
  s.config.loss_from = 15s;
  s.config.loss_until = 15100ms;
  s.config.duration = 30s;
  s.settle = 22s;
  return s;
}

/// A scenario in which no report arrives from 10 to 20 s. The link carries `mbps` from 12 s on.
Scenario Silence(const std::string& name, double mbps, const Parameters& p) {
  Scenario s = Event(name, 8, p);
  const std::string trace = "0 8\n12 " + std::to_string(mbps) + "\n";
  s.config.forward.capacity = *link::Capacity::ParseTrace(trace, false, nullptr);
  s.config.return_outage_from = 10s;
  s.config.return_outage_until = 20s;
  s.config.duration = 24s;
  s.settle = 21s;
  return s;
}

Scenario ClockSet(const std::string& name, Duration sender, Duration receiver,
                  const Parameters& p) {
  Scenario s = Event(name, 8, p);
  FlowConfig& flow = s.config.flows.front();
  flow.clock_jump = 15s;
  flow.sender_jump = sender;
  flow.receiver_jump = receiver;
  s.config.duration = 20s;
  return s;
}

/// A scenario in which the clocks drift by 200 ppm, which is 12 ms per minute.
Scenario ClockDrift(const std::string& name, link::AqmConfig::Kind aqm, const Parameters& p) {
  Scenario s = Event(name, 8, p);
  s.config.forward.aqm.kind = aqm;
  s.config.forward.limit.time = 100ms;
  s.config.flows.front().receiver_drift = 200e-6;
  s.config.duration = 300s;
  return s;
}

/// A scenario with an encoder that sends a fifth of its target at first, and later all of it.
Scenario LimitedThenFree(const Parameters& p) {
  Scenario s = Event("limited_then_free", 20, p);
  s.config.flows.front().sources[0].obedience = [](Duration t) { return t < 15s ? 0.2 : 1.0; };
  s.config.duration = 20s;
  return s;
}

}  // namespace

std::vector<Scenario> EventScenarios(const Parameters& p) {
  using Aqm = link::AqmConfig::Kind;
  std::vector<Scenario> all = {Policed(Event("policer", 10, p)),
                               PolicerLifted(p),
                               Silence("silence", 8, p),
                               Silence("silence_slower", 2, p),
                               ClockSet("clock_back", -1h, 0h, p),
                               ClockSet("clock_ahead", 0h, 1s, p),
                               ClockDrift("clock_drift_marks", Aqm::kRamp, p),
                               ClockDrift("clock_drift_fifo", Aqm::kNone, p),
                               LimitedThenFree(p)};
  Scenario lossy = Event("loss0.5_notect", 8, p);
  lossy.config.forward.aqm.kind = Aqm::kNone;
  lossy.config.forward.limit.time = 100ms;
  lossy.config.forward.loss = 0.005;
  lossy.config.flows.front().parameters.ecn = Ecn::kNotEct;
  all.push_back(lossy);
  return all;
}

}  // namespace lidar::scream::test
