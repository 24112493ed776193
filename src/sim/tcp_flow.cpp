// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/sim/tcp_flow.h"

#include <algorithm>

namespace lidar::scream::test {
namespace {

constexpr DataSize kPacket = DataSize::Bytes(1500);

}  // namespace

TcpFlow::TcpFlow(const TcpConfig& config, int index, Time origin)
    : config_(config),
      index_(index),
      start_(origin + config.start),
      sender_(config.kind, start_, config.slow_start_threshold),
      integrated_(start_) {}

Time TcpFlow::NextEvent(Time now) const {
  if (now < start_) return start_;
  const Time next = std::max(now, sender_.NextEvent());
  return acks_.empty() ? next : std::min(next, acks_.front().arrival);
}

void TcpFlow::Step(Time now, std::vector<WirePacket>* wire, link::Bottleneck* link) {
  if (now < start_) return;
  Integrate(now);
  for (; !acks_.empty() && acks_.front().arrival <= now; acks_.pop_front())
    sender_.OnAck(now, acks_.front().id, acks_.front().ce);
  sender_.OnTimer(now);
  while (sender_.MaySend(now)) SendOne(now, wire, link);
}

void TcpFlow::SendOne(Time now, std::vector<WirePacket>* wire, link::Bottleneck* link) {
  WirePacket packet;
  packet.flow = index_;
  packet.frame = sender_.SendPacket(now);
  packet.size = kPacket;
  ++result_.packets_sent;
  const auto ecn = config_.kind == TcpKind::kPrague ? link::Ecn::kEct1 : config_.ecn;
  link->Enqueue(now, {packet.size, ecn, wire->size()});
  wire->push_back(packet);
}

void TcpFlow::OnArrival(const WirePacket& packet, const link::Outcome& outcome,
                        Duration return_delay) {
  if (!outcome.delivered()) {
    ++result_.packets_lost;
    return;
  }
  result_.delivered_bytes += packet.size.bytes();
  acks_.push_back(
      {outcome.arrival + return_delay, packet.frame, outcome.packet.ecn == link::Ecn::kCe});
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
