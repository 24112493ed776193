// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/sim/tcp_flow.h"

#include <algorithm>
#include <cmath>

namespace lidar::scream::test {
namespace {

constexpr DataSize kPacket = DataSize::Bytes(1500);

}  // namespace

TcpFlow::TcpFlow(const TcpConfig& config, int index, Time origin)
    : config_(config),
      index_(index),
      start_(origin + config.start),
      stop_(config.stop == kNever ? Time::max() : origin + config.stop),
      sender_(config.kind, start_, config.slow_start_threshold),
      random_(static_cast<std::uint64_t>(index) + 1),
      integrated_(start_) {
  if (config.files) BeginFile();
}

/// Creates the sender of the next file, which starts after a pause.
void TcpFlow::BeginFile() {
  const double pause = -std::log(1 - random_.Uniform()) * Seconds(config_.files->mean_pause);
  start_ += FromSeconds(pause);
  const auto shortest = static_cast<double>(config_.files->shortest.bytes());
  const auto longest = static_cast<double>(config_.files->longest.bytes());
  file_packets_ =
      static_cast<std::size_t>(std::ceil((shortest + (longest - shortest) * random_.Uniform()) /
                                         static_cast<double>(kPacket.bytes())));
  acked_ = 0;
  sender_ = TcpSender(config_.kind, start_, config_.slow_start_threshold);
  ++connection_;
}

void TcpFlow::EndFile(Time now) {
  result_.file_s.push_back(Seconds(now - start_));
  start_ = now;
  BeginFile();
}

bool TcpFlow::MoreToSend(Time now) const {
  return now < stop_ && acked_ + sender_.outstanding() < file_packets_;
}

Time TcpFlow::NextEvent(Time now) const {
  if (now < start_) return start_;
  const Time next = std::max(now, MoreToSend(now) ? sender_.NextEvent() : sender_.Timeout());
  return acks_.empty() ? next : std::min(next, acks_.front().arrival);
}

void TcpFlow::Step(Time now, Network* network) {
  if (now < start_) return;
  Integrate(now);
  for (; !acks_.empty() && acks_.front().arrival <= now; acks_.pop_front()) {
    const Ack& ack = acks_.front();
    if (ack.connection != connection_) continue;
    const std::size_t before = sender_.outstanding();
    sender_.OnAck(now, ack.id, ack.ce);
    if (before > sender_.outstanding()) ++acked_;
    if (acked_ >= file_packets_) EndFile(now);
  }
  if (now < start_) return;  // the pause after a file has not ended
  sender_.OnTimer(now);
  while (MoreToSend(now) && sender_.MaySend(now)) SendOne(now, network);
}

void TcpFlow::SendOne(Time now, Network* network) {
  WirePacket packet;
  packet.source = connection_;
  packet.flow = index_;
  packet.frame = sender_.SendPacket(now);
  packet.size = kPacket;
  ++result_.packets_sent;
  const auto ecn = config_.kind == TcpKind::kPrague ? Ecn::kEct1 : config_.ecn;
  network->Send(now, ecn, config_.route, packet);
}

void TcpFlow::OnArrival(const WirePacket& packet, const link::Outcome& outcome,
                        Duration return_delay) {
  if (!outcome.delivered()) {
    ++result_.packets_lost;
    return;
  }
  result_.delivered_bytes += packet.size.bytes();
  acks_.push_back({outcome.arrival + return_delay, packet.frame, outcome.packet.ecn == Ecn::kCe,
                   packet.source});
}

/// Adds the time since the last step to the mean of the window.
void TcpFlow::Integrate(Time now) {
  result_.mean_window += sender_.window() * Seconds(now - integrated_);
  integrated_ = now;
}

TcpResult TcpFlow::Finish(Time now) {
  Integrate(now);
  result_.mean_window /= std::max(1e-9, Seconds(now - start_));
  return result_;
}

}  // namespace lidar::scream::test
