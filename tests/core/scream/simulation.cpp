// SPDX-License-Identifier: LGPL-2.1-or-later
#include "simulation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

namespace lidar::scream::test {
namespace {

constexpr std::int64_t kMaxPacket = 1240;  // 1200 bytes of RTP payload
constexpr std::int64_t kMinPacket = 60;
constexpr std::uint32_t kEpochOfRestart = 0x89ABCDEF;

struct WirePacket {
  int flow = 0;
  std::uint32_t ssrc = 0;
  std::uint16_t seq = 0;
  std::int64_t frame = 0;
  bool marker = false;
  DataSize size;
};

/// A frame source, a sender, and its receiver.
class Flow {
 public:
  Flow(const FlowConfig& config, int index, double seed)
      : config_(config),
        controller_(config.parameters),
        generator_(config.feedback),
        random_(static_cast<std::uint64_t>(seed) + static_cast<std::uint64_t>(index)),
        index_(index),
        ssrc_(1000U + static_cast<std::uint32_t>(index)),
        next_frame_(config.start) {
    stream_ = controller_.AddStream(config.stream);
  }

  Time NextEvent(Time now) {
    Time next = std::min({next_frame_, controller_.NextTimer(), generator_.NextDue()});
    if (const auto wake = Wake(now)) next = std::min(next, *wake);
    if (!reports_.empty()) next = std::min(next, reports_.begin()->first);
    return std::max(next, stalled_until_);
  }

  void Step(Time now, const SimulationConfig& sim, link::Random* loss,
            std::vector<WirePacket>* wire, link::Bottleneck* link) {
    if (Stalled(now)) return;
    while (next_frame_ <= now) MakeFrame(now);
    for (; !reports_.empty() && reports_.begin()->first <= now; reports_.erase(reports_.begin()))
      controller_.OnFeedback(now, reports_.begin()->second);
    if (controller_.NextTimer() <= now) controller_.OnTimer(now);
    DropLate(now);
    Send(now, wire, link);
    if (now - config_.start > config_.receiver_restart) {
      config_.receiver_restart = Duration::max();
      generator_.Reset();
      epoch_ += kEpochOfRestart;
    }
    while (auto report = generator_.Take(now)) {
      report->report_timestamp += epoch_;
      result_.feedback_bytes += static_cast<std::int64_t>(BuildCcfb(*report).size()) + 28;
      if (!loss->Chance(sim.return_loss)) reports_.emplace(now + sim.return_delay, *report);
    }
  }

  void OnArrival(const WirePacket& packet, const link::Outcome& outcome) {
    ++result_.packets_sent;
    if (outcome.fate == link::Fate::kLost) ++result_.packets_random_lost;
    if (!outcome.delivered() && outcome.fate != link::Fate::kLost)
      ++result_.packets_congestion_lost;
    if (!outcome.delivered()) return;
    result_.delivered_bytes += packet.size.bytes();
    generator_.OnPacket(outcome.arrival,
                        {packet.ssrc, packet.seq, static_cast<Ecn>(outcome.packet.ecn),
                         packet.marker, packet.size});
    if (packet.marker)
      result_.frame_latency_ms.push_back(
          Milliseconds(outcome.arrival - created_[static_cast<std::size_t>(packet.frame)]));
  }

  FlowResult Finish(Time now) {
    result_.statistics = controller_.statistics(now);
    return std::move(result_);
  }
  Statistics statistics(Time now) const { return controller_.statistics(now); }

 private:
  /// When the pacing thread, asked to wake at the next packet's time, really does.
  std::optional<Time> Wake(Time now) {
    const auto d = controller_.NextSend(now);
    if (!d) return std::nullopt;
    if (d->time != asked_) {
      asked_ = d->time;
      const bool sleeps = d->time > now && config_.wakeup_delay > Duration{0};
      const double late = sleeps ? Seconds(config_.wakeup_delay) * random_.Uniform() : 0;
      wake_ = std::max(d->time, now) + FromSeconds(late);
    }
    return wake_;
  }

  bool Stalled(Time now) {
    if (config_.stall > Duration{0} && now >= next_stall_) {
      stalled_until_ = now + FromSeconds(Seconds(config_.stall) * random_.Uniform());
      next_stall_ = now + FromSeconds(2 * Seconds(config_.stall_every) * random_.Uniform());
    }
    return now < stalled_until_;
  }

  void MakeFrame(Time now) {
    const Duration since_start = now - config_.start;
    const Duration period = FromSeconds(1 / config_.frames_per_second);
    next_frame_ = since_start + period > config_.stop_after ? Time::max() : next_frame_ + period;
    double scale = 1 + config_.frame_jitter * (2 * random_.Uniform() - 1);
    if (config_.obedience) scale *= config_.obedience(since_start);
    const DataRate target = controller_.target_bitrate(stream_);
    std::int64_t left =
        config_.encoder ? config_.encoder(target).bytes() : (target * scale * period).bytes();
    const auto frame = static_cast<std::int64_t>(created_.size());
    created_.push_back(now);
    ++result_.frames_sent;
    do {
      WirePacket packet;
      packet.flow = index_;
      packet.ssrc = ssrc_;
      packet.seq = seq_++;
      packet.frame = frame;
      packet.size = DataSize::Bytes(std::clamp(left, kMinPacket, kMaxPacket));
      left -= kMaxPacket;
      packet.marker = left <= 0;
      queue_.push_back(packet);
      controller_.OnQueued(now, stream_,
                           {ssrc_, packet.size, packet.marker, static_cast<std::uint32_t>(frame)});
    } while (left > 0);
  }

  void DropLate(Time now) {
    if (!config_.drop_late) return;
    const std::size_t late = controller_.LatePackets(now, stream_);
    if (late == 0) return;
    for (std::size_t i = 0; i < late; ++i) {
      if (queue_.front().marker) ++result_.frames_dropped;
      queue_.pop_front();
    }
    controller_.OnDropped(now, stream_, late);
  }

  void Send(Time now, std::vector<WirePacket>* wire, link::Bottleneck* link) {
    for (auto wake = Wake(now); wake && *wake <= now; wake = Wake(now)) {
      const auto d = controller_.NextSend(now);
      const WirePacket packet = queue_.front();
      queue_.pop_front();
      controller_.OnSent(now, stream_, {packet.ssrc, packet.seq, packet.size, d->ecn});
      link->Enqueue(now, {packet.size, static_cast<link::Ecn>(d->ecn), wire->size()});
      wire->push_back(packet);
    }
  }

  FlowConfig config_;
  Controller controller_;
  FeedbackGenerator generator_;
  link::Random random_;
  int index_;
  std::uint32_t ssrc_;
  Time next_frame_;
  StreamId stream_ = 0;
  Time asked_{};
  Time wake_{};
  Time stalled_until_{};
  Time next_stall_{};
  std::uint32_t epoch_ = 0;
  std::uint16_t seq_ = 65000;  // wraps around early in each run
  std::deque<WirePacket> queue_;
  std::vector<Time> created_;
  std::multimap<Time, CongestionFeedback> reports_;
  FlowResult result_;
};

}  // namespace

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
    flows.push_back(std::make_unique<Flow>(config.flows[i], static_cast<int>(i),
                                           static_cast<double>(config.forward.seed)));
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
      result.packets.push_back(
          {o.sent, o.arrival, Milliseconds(o.sojourn), p.flow, p.size.bytes(), o.delivered()});
    }
    for (auto& flow : flows) flow->Step(now, config, &loss, &wire, &link);
    if (now >= next_sample) {
      for (std::size_t i = 0; i < flows.size(); ++i)
        result.samples.push_back(
            {now, static_cast<int>(i),
             config.forward.capacity.RateAt(now - config.forward.origin).bits_per_second() / 1e6,
             flows[i]->statistics(now)});
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

std::int64_t SimulationResult::DeliveredBytes(Time from, Time until, int flow) const {
  std::int64_t bytes = 0;
  for (const PacketLog& p : packets)
    if (p.delivered && p.arrival >= from && p.arrival < until && (flow < 0 || p.flow == flow))
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
