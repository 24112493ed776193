// SPDX-License-Identifier: LGPL-2.1-or-later
// The sender of a greedy flow: what TCP does as far as a queue sees it, without a clock or a
// socket.
#pragma once
#include <cstdint>
#include <deque>
#include <memory>

#include "src/base/time.h"
#include "src/sim/tcp_window.h"

namespace lidar::scream::test {

/// Each packet is acknowledged by itself, and a hole is lost once three later ones were. What was
/// lost is not sent again: there is always more to send.
class TcpSender {
 public:
  TcpSender(TcpKind kind, Time start, double slow_start_threshold);

  /// When OnTimer() or SendPacket() has something to do; Time::max() where an acknowledgement must
  /// come first.
  Time NextEvent() const;
  bool MaySend(Time now) const;
  /// Accounts for a packet that is sent now, and gives it its number.
  std::uint64_t SendPacket(Time now);
  void OnAck(Time now, std::uint64_t id, bool ce);
  void OnTimer(Time now);

  double window() const { return control_->window; }
  std::size_t outstanding() const { return outstanding_; }
  /// Time at which the acknowledgements are overdue.
  Time Timeout() const;

 private:
  struct InFlight {
    std::uint64_t id = 0;
    Time sent{};
    bool acked = false;
  };

  void Grow(Time now, Duration rtt, std::uint64_t id, bool ce);
  void DetectLoss(std::uint64_t acked);
  void MeasureRtt(Duration rtt);

  TcpKind kind_;
  std::unique_ptr<TcpWindow> control_;
  double slow_start_threshold_;
  bool slow_start_ = true;
  std::deque<InFlight> in_flight_;
  std::size_t outstanding_ = 0;
  std::uint64_t next_id_ = 0;
  std::uint64_t recover_ = 0;  // losses before this one were answered
  Duration s_rtt_{0}, rtt_var_{0};
  Time last_progress_;
  Time next_paced_;
};

}  // namespace lidar::scream::test
