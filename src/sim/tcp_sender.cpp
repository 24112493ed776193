// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/sim/tcp_sender.h"

#include <algorithm>

namespace lidar::scream::test {
namespace {

using namespace std::chrono_literals;

constexpr std::uint64_t kReordering = 3;  // packets
constexpr Duration kMinTimeout = 200ms;   // Linux's value
constexpr Duration kFirstTimeout = 1s;

}  // namespace

TcpSender::TcpSender(TcpKind kind, Time start, double slow_start_threshold)
    : kind_(kind),
      control_(MakeTcpWindow(kind)),
      slow_start_threshold_(slow_start_threshold),
      last_progress_(start),
      next_paced_(start) {}

Time TcpSender::Timeout() const {
  const Duration rto =
      s_rtt_ > Duration{0} ? std::max(kMinTimeout, s_rtt_ + 4 * rtt_var_) : kFirstTimeout;
  return outstanding_ > 0 ? last_progress_ + rto : Time::max();
}

Time TcpSender::NextEvent() const {
  return MaySend(Time::max()) ? std::min(Timeout(), next_paced_) : Timeout();
}

bool TcpSender::MaySend(Time now) const {
  return static_cast<double>(outstanding_) + 1 <= control_->window && next_paced_ <= now;
}

std::uint64_t TcpSender::SendPacket(Time now) {
  if (outstanding_ == 0) last_progress_ = now;
  in_flight_.push_back({next_id_, now});
  ++outstanding_;
  if (kind_ == TcpKind::kPrague && s_rtt_ > Duration{0}) {
    const double pace = control_->window * (slow_start_ ? 2 : 1) / Seconds(s_rtt_);
    next_paced_ = std::max(next_paced_, now) + FromSeconds(1 / pace);
  }
  return next_id_++;
}

void TcpSender::OnTimer(Time now) {
  if (now < Timeout()) return;
  control_->OnTimeout();
  slow_start_ = false;
  in_flight_.clear();
  outstanding_ = 0;
  recover_ = next_id_;
  last_progress_ = now;
}

void TcpSender::OnAck(Time now, std::uint64_t id, bool ce) {
  const auto it = std::lower_bound(in_flight_.begin(), in_flight_.end(), id,
                                   [](const InFlight& p, std::uint64_t i) { return p.id < i; });
  if (it == in_flight_.end() || it->id != id || it->acked) return;
  it->acked = true;
  --outstanding_;
  last_progress_ = now;
  const Duration rtt = now - it->sent;
  MeasureRtt(rtt);
  Grow(now, rtt, id, ce);
  DetectLoss(id);
  while (!in_flight_.empty() && in_flight_.front().acked) in_flight_.pop_front();
}

void TcpSender::Grow(Time now, Duration rtt, std::uint64_t id, bool ce) {
  const bool prague = kind_ == TcpKind::kPrague;
  if (ce && !prague) {
    if (id < recover_) return;  // RFC 3168: at most one reduction per round trip
    recover_ = next_id_;
    slow_start_ = false;
    control_->OnLoss();
  } else if (slow_start_ && ce) {
    slow_start_ = false;
    control_->OnFirstMark();
  } else if (slow_start_) {
    control_->window += 1;
    slow_start_ = control_->window < slow_start_threshold_;
  } else if (prague || id >= recover_) {
    control_->OnAck(now, rtt, ce);
  }
}

void TcpSender::DetectLoss(std::uint64_t acked) {
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

/// Updates the round-trip time as in RFC 6298.
void TcpSender::MeasureRtt(Duration rtt) {
  if (s_rtt_ == Duration{0}) {
    s_rtt_ = rtt;
    rtt_var_ = rtt / 2;
    return;
  }
  const Duration error = rtt > s_rtt_ ? rtt - s_rtt_ : s_rtt_ - rtt;
  rtt_var_ += (error - rtt_var_) / 4;
  s_rtt_ += (rtt - s_rtt_) / 8;
}

}  // namespace lidar::scream::test
