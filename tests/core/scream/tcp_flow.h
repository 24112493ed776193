// SPDX-License-Identifier: LGPL-2.1-or-later
// A greedy flow of somebody else beside ours, in simulated time: TCP as far as a queue sees it.
#pragma once
#include <deque>
#include <memory>
#include <vector>

#include "src/link/bottleneck.h"
#include "tests/core/scream/sim_flow.h"
#include "tests/core/scream/tcp_window.h"

namespace lidar::scream::test {

/// Each packet is acknowledged by itself, and a hole is lost once three later ones were. What was
/// lost is not sent again: there is always more to send.
class TcpFlow {
 public:
  TcpFlow(const TcpConfig& config, int index, Time origin);

  Time NextEvent(Time now) const;
  void Step(Time now, std::vector<WirePacket>* wire, link::Bottleneck* link);
  void OnArrival(const WirePacket& packet, const link::Outcome& outcome, Duration return_delay);
  TcpResult Finish(Time now);

 private:
  struct InFlight {
    std::uint64_t id = 0;
    Time sent{};
    bool acked = false;
  };
  struct Ack {
    Time arrival{};
    std::uint64_t id = 0;
    bool ce = false;
  };

  void OnAck(Time now, const Ack& ack);
  void Grow(Time now, Duration rtt, const Ack& ack);
  void DetectLoss(std::uint64_t acked);
  void MeasureRtt(Duration rtt);
  void Integrate(Time now);
  bool MaySend(Time now) const;
  void SendOne(Time now, std::vector<WirePacket>* wire, link::Bottleneck* link);
  Time Timeout() const;

  TcpConfig config_;
  int index_;
  Time start_;
  std::unique_ptr<TcpWindow> control_;
  bool slow_start_ = true;
  std::deque<InFlight> in_flight_;
  std::size_t outstanding_ = 0;
  std::deque<Ack> acks_;
  std::uint64_t next_id_ = 0;
  std::uint64_t recover_ = 0;  // losses before this one were answered
  Duration s_rtt_{0}, rtt_var_{0};
  Time last_progress_{};
  Time next_paced_{};
  Time integrated_{};
  TcpResult result_;
};

}  // namespace lidar::scream::test
