// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/core/scream/simulation.h"

#include <algorithm>
#include <map>
#include <memory>

#include "tests/core/scream/sim_flow.h"

namespace lidar::scream::test {

Percentiles Summarise(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double p) {
    return values[static_cast<std::size_t>(p * static_cast<double>(values.size() - 1) + 0.5)];
  };
  return {at(0.5), at(0.95), at(0.99), values.back()};
}

SimulationResult Simulate(const SimulationConfig& config) {
  SimulationResult result;
  result.config = config;
  link::Bottleneck link(config.forward);
  link::Random loss(config.forward.seed + 77);
  std::vector<WirePacket> wire;
  std::multimap<Time, link::Outcome> behind;  // the bottleneck, on the longer way
  std::vector<std::unique_ptr<Flow>> flows;
  for (std::size_t i = 0; i < config.flows.size(); ++i)
    flows.push_back(
        std::make_unique<Flow>(config.flows[i], static_cast<int>(i), config.forward.seed));
  const Time end = config.forward.origin + config.duration;
  Time next_sample = config.forward.origin;
  for (Time now = config.forward.origin; now <= end;) {
    for (link::Outcome& o : link.Deliver(now)) {
      if (o.arrival - config.forward.origin > config.longer_from) o.arrival += config.longer_by;
      behind.emplace(o.arrival, o);
    }
    for (; !behind.empty() && behind.begin()->first <= now; behind.erase(behind.begin())) {
      const link::Outcome& o = behind.begin()->second;
      const WirePacket& p = wire[o.packet.id];
      flows[static_cast<std::size_t>(p.flow)]->OnArrival(p, o);
      result.packets.push_back({o.sent, o.arrival, Milliseconds(o.sojourn), p.flow, p.source,
                                p.size.bytes(), o.delivered()});
    }
    for (auto& flow : flows) flow->Step(now, config, &loss, &wire, &link);
    if (now >= next_sample) {
      for (std::size_t i = 0; i < flows.size(); ++i)
        result.samples.push_back(
            {now, static_cast<int>(i),
             config.forward.capacity.RateAt(now - config.forward.origin).bits_per_second() / 1e6,
             flows[i]->statistics(now), flows[i]->targets()});
      next_sample += config.sample_interval;
    }
    Time next = std::min(link.NextEventTime(), next_sample);
    if (!behind.empty()) next = std::min(next, behind.begin()->first);
    for (auto& flow : flows) next = std::min(next, flow->NextEvent(now));
    now = std::max(next, now + Duration{1});
  }
  for (auto& flow : flows) result.flows.push_back(flow->Finish(end));
  return result;
}

std::int64_t SimulationResult::DeliveredBytes(Time from, Time until, int flow, int source) const {
  std::int64_t bytes = 0;
  for (const PacketLog& p : packets)
    if (p.delivered && p.arrival >= from && p.arrival < until && (flow < 0 || p.flow == flow) &&
        (source < 0 || p.source == source))
      bytes += p.bytes;
  return bytes;
}

double SimulationResult::Utilisation(Time from, Time until) const {
  const Time origin = config.forward.origin;
  const Duration delay = config.forward.delay;
  return static_cast<double>(DeliveredBytes(from + delay, until + delay)) /
         static_cast<double>(
             config.forward.capacity.Between(from - origin, until - origin).bytes());
}

Percentiles SimulationResult::QueueDelay(Time from, Time until) const {
  std::vector<double> values;
  for (const PacketLog& p : packets)
    if (p.delivered && p.sent >= from && p.sent < until) values.push_back(p.sojourn_ms);
  return Summarise(std::move(values));
}

}  // namespace lidar::scream::test
