// SPDX-License-Identifier: LGPL-2.1-or-later
// The sender of a greedy flow: TCP as a queue sees it, without a clock and a socket.
#pragma once
#include <cstdint>
#include <deque>
#include <memory>

#include "src/base/time.h"
#include "src/sim/tcp_window.h"

namespace lidar::scream::test {

/// A TCP sender. Each packet has its own acknowledgement. A packet is lost if three later packets
/// were acknowledged. Lost packets are not sent again, but new data are sent instead.
class TcpSender {
 public:
  TcpSender(TcpKind kind, Time start, double slow_start_threshold);

  /// Returns the time of the next OnTimer() or SendPacket(), or Time::max() if the sender must wait
  /// for an acknowledgement.
  Time NextEvent() const;
  bool MaySend(Time now) const;
  /// Call it for each packet that is sent. Returns the packet's number.
  std::uint64_t SendPacket(Time now);
  void OnAck(Time now, std::uint64_t id, bool ce);
  void OnTimer(Time now);

  double window() const { return control_->window; }
  std::size_t outstanding() const { return outstanding_; }
  /// Returns the time at which acknowledgements become overdue.
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
  std::uint64_t recover_ = 0;  // losses of packets before this one do not reduce the window again
  Duration s_rtt_{0}, rtt_var_{0};
  Time last_progress_;
  Time next_paced_;
};

}  // namespace lidar::scream::test
