// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/sim/simulation.h"

#include <algorithm>
#include <map>
#include <memory>

#include "src/sim/sim_flow.h"
#include "src/sim/tcp_flow.h"

namespace lidar::scream::test {

Percentiles Summarise(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double p) {
    return values[static_cast<std::size_t>(p * static_cast<double>(values.size() - 1) + 0.5)];
  };
  return {at(0.5), at(0.95), at(0.99), values.back()};
}

namespace {

class Simulation {
 public:
  explicit Simulation(const SimulationConfig& config)
      : config_(config),
        origin_(config.forward.origin),
        network_(config),
        report_loss_(config.forward.seed + 77),
        next_sample_(origin_) {
    int index = 0;
    for (const FlowConfig& flow : config.flows)
      flows_.push_back(std::make_unique<Flow>(flow, index++, config.forward.seed));
    for (const TcpConfig& other : config.others)
      others_.push_back(std::make_unique<TcpFlow>(other, index++, origin_));
    result_.config = config;
  }

  SimulationResult Run() {
    const Time end = origin_ + config_.duration;
    for (Time now = origin_; now <= end; now = std::max(NextEvent(now), now + Duration{1})) {
      Deliver(now);
      for (auto& flow : flows_) flow->Step(now, config_, &report_loss_, &network_);
      for (auto& other : others_) other->Step(now, &network_);
      if (now >= next_sample_) TakeSamples(now);
    }
    for (auto& flow : flows_) result_.flows.push_back(flow->Finish(end));
    for (auto& other : others_) result_.others.push_back(other->Finish(end));
    return std::move(result_);
  }

 private:
  void Deliver(Time now) {
    for (link::Outcome& o : network_.Deliver(now)) {
      const WirePacket& packet = network_.packet(o.packet.id);
      if (o.arrival - origin_ > config_.longer_from) o.arrival += config_.longer_by;
      if (const auto i = static_cast<std::size_t>(packet.flow); i < flows_.size())
        o.arrival += flows_[i]->access_delay();
      const Duration sent = packet.sent - origin_;
      const bool burst = sent >= config_.loss_from && sent < config_.loss_until;
      if (burst && o.packet.id % 3 != 0) o.fate = link::Fate::kLost;
      behind_.emplace(o.arrival, o);
    }
    for (; !behind_.empty() && behind_.begin()->first <= now; behind_.erase(behind_.begin()))
      Arrive(behind_.begin()->second);
  }

  void Arrive(const link::Outcome& o) {
    const WirePacket& p = network_.packet(o.packet.id);
    const auto flow = static_cast<std::size_t>(p.flow);
    if (flow < flows_.size())
      flows_[flow]->OnArrival(p, o);
    else
      others_[flow - flows_.size()]->OnArrival(p, o, config_.return_delay);
    if (p.report.empty())
      result_.packets.push_back({p.sent, o.arrival, Milliseconds(p.sojourn), p.flow, p.source,
                                 p.size.bytes(), o.delivered()});
  }

  void TakeSamples(Time now) {
    const double mbps = config_.forward.capacity.RateAt(now - origin_).bits_per_second() / 1e6;
    for (std::size_t i = 0; i < flows_.size(); ++i)
      result_.samples.push_back(
          {now, static_cast<int>(i), mbps, flows_[i]->statistics(now), flows_[i]->targets()});
    next_sample_ += config_.sample_interval;
  }

  Time NextEvent(Time now) {
    Time next = std::min(network_.NextEventTime(), next_sample_);
    if (!behind_.empty()) next = std::min(next, behind_.begin()->first);
    for (auto& flow : flows_) next = std::min(next, flow->NextEvent(now));
    for (auto& other : others_) next = std::min(next, other->NextEvent(now));
    return next;
  }

  const SimulationConfig& config_;
  Time origin_;
  Network network_;
  link::Random report_loss_;
  Time next_sample_;
  std::multimap<Time, link::Outcome> behind_;  // packets after the last link, by time of arrival
  std::vector<std::unique_ptr<Flow>> flows_;
  std::vector<std::unique_ptr<TcpFlow>> others_;
  SimulationResult result_;
};

}  // namespace

SimulationResult Simulate(const SimulationConfig& config) { return Simulation(config).Run(); }

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
