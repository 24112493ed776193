// SPDX-License-Identifier: LGPL-2.1-or-later
// A greedy background flow that shares links with our flows, in simulated time.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "src/link/random.h"
#include "src/sim/network.h"
#include "src/sim/tcp_sender.h"

namespace lidar::scream::test {

class TcpFlow {
 public:
  TcpFlow(const TcpConfig& config, int index, Time origin);

  Time NextEvent(Time now) const;
  void Step(Time now, Network* network);
  void OnArrival(const WirePacket& packet, const link::Outcome& outcome, Duration return_delay);
  TcpResult Finish(Time now);

 private:
  struct Ack {
    Time arrival{};
    std::uint64_t id = 0;
    bool ce = false;
    int connection = 0;
  };

  void Integrate(Time now);
  void BeginFile();
  void EndFile(Time now);
  bool MoreToSend(Time now) const;
  void SendOne(Time now, Network* network);

  TcpConfig config_;
  int index_;
  Time start_;  // start of the current file
  Time stop_;
  TcpSender sender_;
  link::Random random_;
  int connection_ = 0;
  std::size_t file_packets_ = SIZE_MAX;
  std::size_t acked_ = 0;  // acknowledged packets of the current file
  std::deque<Ack> acks_;
  Time integrated_;
  TcpResult result_;
};

}  // namespace lidar::scream::test
