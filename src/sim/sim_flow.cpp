// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/sim/sim_flow.h"

#include <algorithm>

namespace lidar::scream::test {
namespace {

constexpr std::int64_t kMaxPacket = 1240;  // 1200 bytes of RTP payload
constexpr std::int64_t kMinPacket = 60;
constexpr std::int64_t kIpUdp = 28;
constexpr std::uint32_t kEpochOfRestart = 0x89ABCDEF;

/// Sets the stream's bitrates for the bounds of an encoder, as screamtx does.
StreamConfig WithBounds(StreamConfig stream, const EncoderBounds& bounds) {
  if (bounds.max > DataRate{}) stream.max_bitrate = std::min(stream.max_bitrate, bounds.max);
  stream.min_bitrate = std::min(stream.min_bitrate, stream.max_bitrate);
  stream.needed_bitrate = std::clamp(bounds.min, stream.min_bitrate, stream.max_bitrate);
  stream.start_bitrate =
      std::clamp(stream.start_bitrate, stream.needed_bitrate, stream.max_bitrate);
  return stream;
}

/// Returns true once: in the first call after the time `at`.
bool Due(Duration since_start, Duration* at) {
  if (since_start <= *at) return false;
  *at = kNever;
  return true;
}

}  // namespace

Flow::Flow(const FlowConfig& config, int index, std::uint64_t seed)
    : config_(config),
      generator_(config.feedback),
      random_(seed + static_cast<std::uint64_t>(index)),
      index_(index) {
  for (std::size_t i = 0; i < config.sources.size(); ++i) {
    sources_.emplace_back();
    sources_.back().next_frame = config.start;
  }
  StartSender();
}

void Flow::StartSender() {
  controller_ = std::make_unique<Controller>(config_.parameters);
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    SourceState& source = sources_[i];
    source.queue.clear();
    source.queued.clear();
    source.seq = 65000;
    source.ssrc = 1000U * (1 + static_cast<std::uint32_t>(i)) + static_cast<std::uint32_t>(index_) +
                  100 * generation_;
    source.stream = controller_->AddStream(config_.sources[i].stream);
    source.told = controller_->target_bitrate(source.stream);
    source.notifier.Reset();
  }
}

Flow::SourceState* Flow::Owner(StreamId stream) {
  const auto it = std::find_if(sources_.begin(), sources_.end(),
                               [&](const SourceState& s) { return s.stream == stream; });
  return &*it;
}

Time Flow::NextEvent(Time now) {
  Time next =
      std::min(Back(controller_->NextTimer(), sender_offset_), FromReceiver(generator_.NextDue()));
  for (const SourceState& source : sources_) next = std::min(next, source.next_frame);
  if (const auto wake = Wake(now)) next = std::min(next, *wake);
  if (!reports_.empty()) next = std::min(next, reports_.begin()->first);
  return std::max(next, stalled_until_);
}

/// Applies those of the configured events that are due.
void Flow::Happen(Time now) {
  const Duration t = now - config_.start;
  if (Due(t, &config_.receiver_restart)) {
    generator_.Reset();
    epoch_ += kEpochOfRestart;
  }
  if (Due(t, &config_.sender_restart)) {
    ++generation_;
    StartSender();
  }
  if (Due(t, &config_.sequence_jump))
    for (SourceState& source : sources_)
      source.seq = static_cast<std::uint16_t>(source.seq - config_.jump_back);
  if (Due(t, &config_.route_change)) controller_->OnRouteChange(ToSender(now));
  if (Due(t, &config_.clock_jump)) {
    sender_offset_ += config_.sender_jump;
    receiver_offset_ += config_.receiver_jump;
  }
}

void Flow::Step(Time now, const SimulationConfig& sim, link::Random* loss, Network* network) {
  if (Stalled(now)) return;
  Happen(now);
  TellEncoders(now);
  for (std::size_t i = 0; i < sources_.size(); ++i)
    while (sources_[i].next_frame <= now) MakeFrame(now, i);
  for (; !reports_.empty() && reports_.begin()->first <= now; reports_.erase(reports_.begin())) {
    const auto& bytes = reports_.begin()->second;
    if (const auto report = parser_.Parse({bytes.data(), bytes.size()}))
      controller_->OnFeedback(ToSender(now), *report);
  }
  if (controller_->NextTimer() <= ToSender(now)) controller_->OnTimer(ToSender(now));
  TellEncoders(now);
  DropLate(now);
  Send(now, network);
  Report(now, sim, loss, network);
}

void Flow::Report(Time now, const SimulationConfig& sim, link::Random* loss, Network* network) {
  const Duration t = now - config_.start;
  const bool outage = t >= sim.return_outage_from && t < sim.return_outage_until;
  while (auto report = generator_.Take(ToReceiver(now))) {
    report->report_timestamp += epoch_;
    if (!config_.arrival_times)
      for (rtcp::SsrcReport& block : report->blocks)
        for (rtcp::PacketMetric& metric : block.metrics) metric.arrival_offset.reset();
    auto bytes = rtcp::BuildCcfb(*report);
    result_.feedback_bytes += static_cast<std::int64_t>(bytes.size()) + kIpUdp;
    if (loss->Chance(sim.return_loss) || outage) continue;
    if (config_.return_route.empty()) {
      reports_.emplace(now + sim.return_delay + config_.access_delay, std::move(bytes));
      continue;
    }
    WirePacket packet;
    packet.flow = index_;
    packet.size = DataSize::Bytes(static_cast<std::int64_t>(bytes.size()) + kIpUdp);
    packet.report = std::move(bytes);
    network->Send(now, Ecn::kNotEct, config_.return_route, std::move(packet));
  }
}

void Flow::OnArrival(const WirePacket& packet, const link::Outcome& outcome) {
  if (!packet.report.empty()) {
    if (outcome.delivered()) reports_.emplace(outcome.arrival, packet.report);
    return;
  }
  ++result_.packets_sent;
  if (outcome.fate == link::Fate::kLost) ++result_.packets_random_lost;
  if (!outcome.delivered() && outcome.fate != link::Fate::kLost) ++result_.packets_congestion_lost;
  if (!outcome.delivered()) return;
  result_.delivered_bytes += packet.size.bytes();
  generator_.OnPacket(ToReceiver(outcome.arrival),
                      {packet.ssrc, packet.seq, outcome.packet.ecn, packet.marker, packet.size});
  FrameLog& frame = result_.frames[packet.frame];
  if (!outcome.duplicate) ++frame.delivered;
  frame.arrival = std::max(frame.arrival, outcome.arrival);
  if (packet.marker)
    result_.frame_latency_ms.push_back(Milliseconds(outcome.arrival - frame.created));
}

FlowResult Flow::Finish(Time now) {
  result_.statistics = statistics(now);
  return std::move(result_);
}

std::vector<DataRate> Flow::targets() const {
  std::vector<DataRate> targets;
  for (const SourceState& source : sources_)
    targets.push_back(controller_->target_bitrate(source.stream));
  return targets;
}

/// Returns the time at which the pacing thread wakes up for the next packet.
std::optional<Time> Flow::Wake(Time now) {
  const auto d = controller_->NextSend(ToSender(now));
  if (!d) return std::nullopt;
  const Time due = Back(d->time, sender_offset_);
  if (due != asked_) {
    asked_ = due;
    const bool sleeps = due > now && config_.wakeup_delay > Duration{0};
    const double late = sleeps ? Seconds(config_.wakeup_delay) * random_.Uniform() : 0;
    wake_ = std::max(due, now) + FromSeconds(late);
  }
  return wake_;
}

bool Flow::Stalled(Time now) {
  if (config_.stall > Duration{0} && now >= next_stall_) {
    stalled_until_ = now + FromSeconds(Seconds(config_.stall) * random_.Uniform());
    next_stall_ = now + FromSeconds(2 * Seconds(config_.stall_every) * random_.Uniform());
  }
  return now < stalled_until_;
}

void Flow::MakeFrame(Time now, std::size_t index) {
  const SourceConfig& config = config_.sources[index];
  SourceState& source = sources_[index];
  const Duration since_start = now - config_.start;
  const Duration period = FromSeconds(1 / config.frames_per_second);
  source.next_frame = since_start + period > std::min(config_.stop_after, config.stop_at)
                          ? Time::max()
                          : source.next_frame + period;
  if (since_start >= config.pause_from && since_start < config.pause_until) return;
  const EncodedFrame encoded = Encode(now, index);
  const DataSize size = encoded.size;
  FrameLog frame;
  frame.created = now;
  frame.source = static_cast<int>(index);
  frame.bytes = size.bytes();
  if (size > DataSize()) {
    ++result_.frames_sent;
    Packetize(now, &source, encoded, &frame);
  }
  result_.frames.push_back(frame);
}

/// Returns the next frame. Its size is the size on the wire, or 0 if the encoder leaves the frame
/// out.
EncodedFrame Flow::Encode(Time now, std::size_t index) {
  SourceConfig& config = config_.sources[index];
  SourceState& source = sources_[index];
  if (config.encoder) {
    const EncodedFrame frame = config.encoder(source.told);
    if (frame.bounds)
      controller_->ConfigureStream(source.stream, WithBounds(config.stream, *frame.bounds));
    return frame;
  }
  double scale = 1 + config.frame_jitter * (2 * random_.Uniform() - 1);
  if (config.obedience) scale *= config.obedience(now - config_.start);
  const Duration period = FromSeconds(1 / config.frames_per_second);
  EncodedFrame frame;
  frame.size = std::max(controller_->target_bitrate(source.stream) * scale * period,
                        DataSize::Bytes(kMinPacket));
  return frame;
}

void Flow::Packetize(Time now, SourceState* source, const EncodedFrame& encoded, FrameLog* frame) {
  for (std::int64_t left = encoded.size.bytes(); left > 0; left -= kMaxPacket) {
    WirePacket packet;
    packet.flow = index_;
    packet.source = frame->source;
    packet.ssrc = source->ssrc;
    packet.seq = source->seq++;
    packet.frame = result_.frames.size();
    packet.size = DataSize::Bytes(std::clamp(left, kMinPacket, kMaxPacket));
    packet.marker = left <= kMaxPacket;
    source->queue.push_back(packet);
    source->queued.push_back(now);
    ++frame->packets;
    controller_->OnQueued(ToSender(now), source->stream,
                          {source->ssrc, packet.size, packet.marker,
                           static_cast<std::uint32_t>(packet.frame), encoded.group});
  }
}

/// Sends targets to the encoders as often as screamtx does.
void Flow::TellEncoders(Time now) {
  for (SourceState& source : sources_) {
    const DataRate target = controller_->target_bitrate(source.stream);
    if (source.notifier.ShouldNotify(ToSender(now), target)) source.told = target;
  }
}

/// Returns how many packets remain of a frame of which a part was sent, if they have waited too
/// long, or else 0.
std::size_t Flow::StuckPackets(const SourceState& source, Time now) const {
  if (source.queue.empty() || now - source.queued.front() < config_.longest_stay) return 0;
  const std::size_t frame = source.queue.front().frame;
  std::size_t packets = 0;
  while (packets < source.queue.size() && source.queue[packets].frame == frame) ++packets;
  return packets;
}

void Flow::DropLate(Time now) {
  if (!config_.drop_late) return;
  for (SourceState& source : sources_) {
    std::size_t late = controller_->LatePackets(ToSender(now), source.stream);
    if (late == 0) late = StuckPackets(source, now);
    if (late == 0) continue;
    for (std::size_t i = 0; i < late; ++i) {
      if (source.queue.front().marker) ++result_.frames_dropped;
      source.queue.pop_front();
      source.queued.pop_front();
    }
    controller_->OnDropped(ToSender(now), source.stream, late);
  }
}

void Flow::Send(Time now, Network* network) {
  for (auto wake = Wake(now); wake && *wake <= now; wake = Wake(now)) {
    const auto d = controller_->NextSend(ToSender(now));
    SourceState* source = Owner(d->stream);
    const WirePacket packet = source->queue.front();
    source->queue.pop_front();
    source->queued.pop_front();
    controller_->OnSent(ToSender(now), d->stream, {packet.ssrc, packet.seq, packet.size, d->ecn});
    network->Send(now, d->ecn, config_.route, packet);
  }
}

}  // namespace lidar::scream::test
