// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/core/scream/tcp_flow.h"

#include <algorithm>

namespace lidar::scream::test {
namespace {

constexpr DataSize kPacket = DataSize::Bytes(1500);
constexpr std::uint64_t kReordering = 3;  // packets
constexpr Duration kMinTimeout = 200ms;   // as Linux has it
constexpr Duration kFirstTimeout = 1s;

}  // namespace

TcpFlow::TcpFlow(const TcpConfig& config, int index, Time origin)
    : config_(config),
      index_(index),
      start_(origin + config.start),
      control_(MakeTcpWindow(config.kind)),
      last_progress_(start_),
      next_paced_(start_),
      integrated_(start_) {}

Time TcpFlow::Timeout() const {
  const Duration rto =
      s_rtt_ > Duration{0} ? std::max(kMinTimeout, s_rtt_ + 4 * rtt_var_) : kFirstTimeout;
  return outstanding_ > 0 ? last_progress_ + rto : Time::max();
}

Time TcpFlow::NextEvent(Time now) const {
  if (now < start_) return start_;
  Time next = Timeout();
  if (!acks_.empty()) next = std::min(next, acks_.front().arrival);
  if (MaySend(Time::max())) next = std::min(next, std::max(now, next_paced_));
  return next;
}

bool TcpFlow::MaySend(Time now) const {
  return static_cast<double>(outstanding_) + 1 <= control_->window && next_paced_ <= now;
}

void TcpFlow::Step(Time now, std::vector<WirePacket>* wire, link::Bottleneck* link) {
  if (now < start_) return;
  Integrate(now);
  for (; !acks_.empty() && acks_.front().arrival <= now; acks_.pop_front())
    OnAck(now, acks_.front());
  if (now >= Timeout()) {
    control_->OnTimeout();
    slow_start_ = false;
    in_flight_.clear();
    outstanding_ = 0;
    recover_ = next_id_;
    last_progress_ = now;
  }
  while (MaySend(now)) SendOne(now, wire, link);
}

void TcpFlow::SendOne(Time now, std::vector<WirePacket>* wire, link::Bottleneck* link) {
  WirePacket packet;
  packet.flow = index_;
  packet.frame = next_id_;
  packet.size = kPacket;
  if (outstanding_ == 0) last_progress_ = now;
  in_flight_.push_back({next_id_++, now});
  ++outstanding_;
  ++result_.packets_sent;
  if (config_.kind == TcpKind::kPrague && s_rtt_ > Duration{0}) {
    const double pace = control_->window * (slow_start_ ? 2 : 1) / Seconds(s_rtt_);
    next_paced_ = std::max(next_paced_, now) + FromSeconds(1 / pace);
  }
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

void TcpFlow::OnAck(Time now, const Ack& ack) {
  const auto it = std::find_if(in_flight_.begin(), in_flight_.end(),
                               [&](const InFlight& p) { return p.id == ack.id; });
  if (it == in_flight_.end() || it->acked) return;
  it->acked = true;
  --outstanding_;
  last_progress_ = now;
  const Duration rtt = now - it->sent;
  MeasureRtt(rtt);
  Grow(now, rtt, ack);
  DetectLoss(ack.id);
  while (!in_flight_.empty() && in_flight_.front().acked) in_flight_.pop_front();
}

void TcpFlow::Grow(Time now, Duration rtt, const Ack& ack) {
  const bool prague = config_.kind == TcpKind::kPrague;
  if (ack.ce && !prague) {
    if (ack.id < recover_) return;  // RFC 3168: once a round trip
    recover_ = next_id_;
    slow_start_ = false;
    control_->OnLoss();
  } else if (slow_start_ && ack.ce) {
    slow_start_ = false;
    control_->OnFirstMark();
  } else if (slow_start_) {
    control_->window += 1;
    slow_start_ = control_->window < config_.slow_start_threshold;
  } else if (prague || ack.id >= recover_) {
    control_->OnAck(now, rtt, ack.ce);
  }
}

void TcpFlow::DetectLoss(std::uint64_t acked) {
  bool lost = false;
  while (!in_flight_.empty() && in_flight_.front().id + kReordering <= acked) {
    const InFlight& p = in_flight_.front();
    if (!p.acked) {
      --outstanding_;
      lost = lost || p.id >= recover_;
    }
    in_flight_.pop_front();
  }
  if (!lost) return;
  recover_ = next_id_;
  slow_start_ = false;
  control_->OnLoss();
}

/// RFC 6298.
void TcpFlow::MeasureRtt(Duration rtt) {
  if (s_rtt_ == Duration{0}) {
    s_rtt_ = rtt;
    rtt_var_ = rtt / 2;
    return;
  }
  const Duration error = rtt > s_rtt_ ? rtt - s_rtt_ : s_rtt_ - rtt;
  rtt_var_ += (error - rtt_var_) / 4;
  s_rtt_ += (rtt - s_rtt_) / 8;
}

/// Adds the time since the last step to the mean of the window.
void TcpFlow::Integrate(Time now) {
  result_.mean_window += control_->window * Seconds(now - integrated_);
  integrated_ = now;
}

TcpResult TcpFlow::Finish(Time now) {
  Integrate(now);
  result_.mean_window /= std::max(1e-9, Seconds(now - start_));
  return result_;
}

}  // namespace lidar::scream::test
