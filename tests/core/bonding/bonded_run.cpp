// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/core/bonding/bonded_run.h"

#include <algorithm>
#include <deque>
#include <map>
#include <memory>

#include "src/base/target_notifier.h"
#include "src/rtcp/feedback_generator.h"
#include "src/scream/controller.h"
#include "src/sim/network.h"
#include "src/sim/simulated_time.h"
#include "src/sim/tcp_flow.h"

namespace lidar::bonding::test {
namespace {

using namespace std::chrono_literals;

constexpr Duration kStep = 500us;
constexpr std::int64_t kMaxPacket = 1240;
constexpr std::uint32_t kStreamSsrc = 7;
constexpr Duration kInTime = 200ms;

using scream::test::Network;
using scream::test::WirePacket;

struct SliceLog {
  Time made{};
  int packets = 0;
  int arrived = 0;
  Time whole{};
};

/// A simulated link with its FIFO, congestion control, path and receiver.
class SimLink {
 public:
  SimLink(const LinkConfig& config, std::size_t index, std::size_t bottleneck)
      : config_(config), index_(index), route_{bottleneck} {
    scream::StreamConfig stream;
    stream.start_bitrate = DataRate::BitsPerSecond(4e6);
    stream.max_bitrate = DataRate::BitsPerSecond(100e6);
    stream_ = controller_.AddStream(config_of_stream_ = stream);
  }

  void Configure(const scream::test::EncoderBounds& bounds) {
    scream::StreamConfig c = config_of_stream_;
    if (bounds.max > DataRate{}) c.max_bitrate = std::min(c.max_bitrate, bounds.max);
    c.min_bitrate = std::min(c.min_bitrate, c.max_bitrate);
    c.needed_bitrate = std::clamp(bounds.min, c.min_bitrate, c.max_bitrate);
    c.start_bitrate = std::clamp(c.start_bitrate, c.needed_bitrate, c.max_bitrate);
    controller_.ConfigureStream(stream_, c);
  }

  void Queue(Time now, const WirePacket& packet) {
    fifo_.push_back(packet);
    controller_.OnQueued(
        now, stream_,
        {kStreamSsrc, packet.size, packet.marker, static_cast<std::uint32_t>(packet.frame),
         static_cast<std::uint32_t>(packet.source)});
  }

  void OnArrival(const WirePacket& p, const link::Outcome& o) {
    generator_.OnPacket(o.arrival + config_.receiver_clock,
                        {kStreamSsrc, p.seq, o.packet.ecn, p.marker, p.size});
  }

  using Links = std::vector<std::unique_ptr<SimLink>>;
  /// Advances the link to the time `now`. The reports that arrive on this link are those of the
  /// receiver of `reported`.
  void Step(Time now, Scheduler* scheduler, SimLink* reported, const Links& links) {
    while (auto report = reported->generator_.Take(now + reported->config_.receiver_clock))
      reports_.emplace(now + config_.rtt / 2, *report);
    for (; !reports_.empty() && reports_.begin()->first <= now; reports_.erase(reports_.begin())) {
      const auto bytes = rtcp::BuildCcfb(reports_.begin()->second);
      const auto report = parser_.Parse({bytes.data(), bytes.size()});
      if (Take(now, scheduler, *report)) continue;
      if (const auto owner = scheduler->OwnerOf(*report))
        links[*owner]->Take(now, scheduler, *report);
    }
    if (controller_.NextTimer() <= now) controller_.OnTimer(now);
    const scream::Statistics s = controller_.statistics(now);
    const DataRate rate = s.s_rtt > Duration{0} ? s.ref_wnd / s.s_rtt : DataRate{};
    scheduler->OnPath(index_, {rate, s.s_rtt, s.min_rtt});
  }

  bool Take(Time now, Scheduler* scheduler, const rtcp::CongestionFeedback& report) {
    const auto own = scheduler->OnFeedback(now, index_, report);
    if (own) controller_.OnFeedback(now, *own);
    return own.has_value();
  }

  void Send(Time now, Scheduler* scheduler, Network* network) {
    Drop(now, controller_.LatePackets(now, stream_), scheduler);
    for (;;) {
      while (!fifo_.empty() && !scheduler->Wants(now, index_, {kStreamSsrc, fifo_.front().seq})) {
        if (scheduler->OnDropped(now, index_, {kStreamSsrc, fifo_.front().seq}))
          controller_.OnUnneeded(now, stream_);
        else
          controller_.OnDropped(now, stream_, 1);
        fifo_.pop_front();
      }
      const auto d = controller_.NextSend(now);
      if (!d || d->time > now) return;
      WirePacket p = fifo_.front();
      fifo_.pop_front();
      const std::uint16_t number = scheduler->OnSent(now, index_, {kStreamSsrc, p.seq});
      controller_.OnSent(now, stream_, {kStreamSsrc, number, p.size, d->ecn});
      bytes_ += p.size.bytes();
      p.flow = static_cast<int>(index_);
      network->Send(now, d->ecn, route_, p);
    }
  }

  DataRate target() const { return controller_.target_bitrate(stream_); }
  std::int64_t bytes() const { return bytes_; }

 private:
  void Drop(Time now, std::size_t packets, Scheduler* scheduler) {
    if (packets == 0) return;
    for (std::size_t i = 0; i < packets; ++i) {
      scheduler->OnDropped(now, index_, {kStreamSsrc, fifo_.front().seq});
      fifo_.pop_front();
    }
    controller_.OnDropped(now, stream_, packets);
  }

  LinkConfig config_;
  std::size_t index_;
  scream::test::Route route_;
  scream::Controller controller_{scream::Parameters{}};
  scream::StreamConfig config_of_stream_;
  scream::StreamId stream_ = 0;
  rtcp::FeedbackGenerator generator_;
  rtcp::CcfbParser parser_;
  std::deque<WirePacket> fifo_;
  std::multimap<Time, rtcp::CongestionFeedback> reports_;
  std::int64_t bytes_ = 0;
};

scream::test::SimulationConfig PathsOf(const RunConfig& config) {
  scream::test::SimulationConfig paths;
  std::uint64_t seed = 10;
  for (const LinkConfig& c : config.links) {
    link::BottleneckConfig path;
    path.origin = kStart;
    path.capacity = c.capacity;
    path.delay = c.rtt / 2;
    path.loss = c.loss;
    path.aqm = c.aqm;
    path.limit = c.limit;
    path.path = c.path;
    path.seed = seed++;
    if (seed == 11)
      paths.forward = path;
    else
      paths.more_links.push_back(path);
  }
  return paths;
}

class BondedRun {
 public:
  explicit BondedRun(const RunConfig& config)
      : config_(config),
        network_(PathsOf(config)),
        scheduler_(config.links.size(), config.method, config.rule),
        source_(config.source) {
    for (std::size_t i = 0; i < config.links.size(); ++i)
      links_.push_back(
          std::make_unique<SimLink>(config.links[i], i, config.one_bottleneck ? 0 : i));
    for (const scream::test::TcpConfig& other : config.others)
      others_.push_back(std::make_unique<scream::test::TcpFlow>(
          other, static_cast<int>(links_.size() + others_.size()), kStart));
    told_ = Target(kStart);
  }

  RunResult Run() {
    const Duration period =
        FromSeconds(1 / (config_.source.scans_per_second * config_.source.slices));
    Time next = kStart;
    for (Time now = kStart; now < kStart + config_.duration + 1s; now += kStep) {
      Deliver(now);
      for (auto& other : others_) other->Step(now, &network_);
      for (std::size_t i = 0; i < links_.size(); ++i) StepLink(now, i);
      TellEncoder(now);
      if (now >= next && now < kStart + config_.duration) {
        MakeSlice(now);
        next += period;
      }
      for (const Scheduler::Copy& copy : scheduler_.TakeCopies(now))
        links_[copy.link]->Queue(now, packets_[copy.id.seq]);
      for (auto& link : links_) link->Send(now, &scheduler_, &network_);
    }
    return Finish();
  }

 private:
  void StepLink(Time now, std::size_t i) {
    const LinkConfig& c = config_.links[i];
    const Duration t = now - kStart;
    scheduler_.SetUsable(now, i, t < c.unusable_from || t >= c.unusable_until);
    const bool swapped = t >= config_.swapped_from;
    links_[i]->Step(now, &scheduler_, links_[swapped ? 1 - i : i].get(), links_);
  }

  void Deliver(Time now) {
    for (const link::Outcome& o : network_.Deliver(now)) behind_.emplace(o.arrival, o);
    for (; !behind_.empty() && behind_.begin()->first <= now; behind_.erase(behind_.begin())) {
      const link::Outcome& o = behind_.begin()->second;
      const WirePacket& p = network_.packet(o.packet.id);
      const auto flow = static_cast<std::size_t>(p.flow);
      if (flow >= links_.size())
        others_[flow - links_.size()]->OnArrival(p, o, config_.links[0].rtt / 2);
      else if (o.delivered())
        OnArrival(flow, p, o);
    }
  }

  void OnArrival(std::size_t link, const WirePacket& p, const link::Outcome& o) {
    links_[link]->OnArrival(p, o);
    Arrive(p, o.arrival);
  }

  void Arrive(const WirePacket& p, Time at) {
    if (seen_[p.frame * 65536 + p.seq]) return;
    seen_[p.frame * 65536 + p.seq] = true;
    SliceLog& slice = slices_[p.frame];
    if (++slice.arrived == slice.packets) slice.whole = at;
  }

  DataRate Target(Time now) const {
    std::vector<DataRate> targets;
    for (const auto& link : links_) targets.push_back(link->target());
    return scheduler_.Target(now, targets);
  }

  void TellEncoder(Time now) {
    const DataRate target = Target(now);
    if (!notifier_.ShouldNotify(now, target)) return;
    told_ = target;
    result_.targets.push_back({now - kStart, target});
  }

  void MakeSlice(Time now) {
    const scream::test::EncodedFrame frame = source_.Next(told_);
    if (frame.bounds)
      for (auto& link : links_) link->Configure(*frame.bounds);
    SliceLog log;
    log.made = now;
    result_.media_bytes += frame.size.bytes();
    for (std::int64_t left = frame.size.bytes(); left > 0; left -= kMaxPacket) {
      WirePacket p;
      p.seq = seq_++;
      p.frame = slices_.size();
      p.size = DataSize::Bytes(std::clamp<std::int64_t>(left, 60, kMaxPacket));
      p.marker = left <= kMaxPacket;
      p.source = static_cast<int>(frame.group.value_or(0));
      packets_[p.seq] = p;
      ++log.packets;
      const LinkSet links = scheduler_.OnPacket(
          now, {{kStreamSsrc, p.seq}, p.size, static_cast<std::uint32_t>(p.frame), p.marker});
      for (std::size_t i = 0; i < links_.size(); ++i)
        if (links[i]) links_[i]->Queue(now, p);
    }
    slices_.push_back(log);
  }

  RunResult Finish() {
    const std::size_t per_scan = config_.source.slices;
    for (std::size_t i = 0; i + per_scan <= slices_.size(); i += per_scan) {
      bool in_time = true;
      double age = 0;
      for (std::size_t k = i; k < i + per_scan; ++k) {
        const SliceLog& s = slices_[k];
        const bool whole = s.packets > 0 && s.arrived == s.packets;
        const double ms = whole ? Milliseconds(s.whole - s.made) : 1e9;
        if (whole) result_.latency_ms.push_back(ms);
        age = std::max(age, ms);
        in_time = in_time && whole && s.whole - s.made <= kInTime;
      }
      ++result_.scans;
      result_.in_time += in_time;
      result_.scan_age_ms.push_back(age);
    }
    for (auto& other : others_)
      result_.other_bytes += other->Finish(kStart + config_.duration).delivered_bytes;
    std::sort(result_.latency_ms.begin(), result_.latency_ms.end());
    for (std::size_t i = 0; i < links_.size(); ++i) {
      result_.link_bytes.push_back(links_[i]->bytes());
      result_.counters.push_back(scheduler_.counters(i));
    }
    return std::move(result_);
  }

  RunConfig config_;
  Network network_;
  Scheduler scheduler_;
  loop::LoopSource source_;
  std::vector<std::unique_ptr<SimLink>> links_;
  std::vector<std::unique_ptr<scream::test::TcpFlow>> others_;
  std::multimap<Time, link::Outcome> behind_;
  std::vector<SliceLog> slices_;
  std::map<std::uint16_t, WirePacket> packets_;
  std::map<std::size_t, bool> seen_;
  std::uint16_t seq_ = 65000;
  TargetNotifier notifier_;
  DataRate told_;
  RunResult result_;
};

}  // namespace

double RunResult::Latency(double percent) const {
  if (latency_ms.empty()) return 0;
  const auto i = static_cast<std::size_t>(percent / 100 * static_cast<double>(latency_ms.size()));
  return latency_ms[std::min(i, latency_ms.size() - 1)];
}

RunResult Simulate(const RunConfig& config) { return BondedRun(config).Run(); }

}  // namespace lidar::bonding::test
