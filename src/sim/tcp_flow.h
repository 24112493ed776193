// SPDX-License-Identifier: LGPL-2.1-or-later
// A greedy flow of somebody else beside ours, in simulated time.
#pragma once
#include <deque>
#include <vector>

#include "src/link/bottleneck.h"
#include "src/sim/sim_flow.h"
#include "src/sim/tcp_sender.h"

namespace lidar::scream::test {

class TcpFlow {
 public:
  TcpFlow(const TcpConfig& config, int index, Time origin);

  Time NextEvent(Time now) const;
  void Step(Time now, std::vector<WirePacket>* wire, link::Bottleneck* link);
  void OnArrival(const WirePacket& packet, const link::Outcome& outcome, Duration return_delay);
  TcpResult Finish(Time now);

 private:
  struct Ack {
    Time arrival{};
    std::uint64_t id = 0;
    bool ce = false;
  };

  void Integrate(Time now);
  void SendOne(Time now, std::vector<WirePacket>* wire, link::Bottleneck* link);

  TcpConfig config_;
  int index_;
  Time start_;
  TcpSender sender_;
  std::deque<Ack> acks_;
  Time integrated_;
  TcpResult result_;
};

}  // namespace lidar::scream::test
