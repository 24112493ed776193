// SPDX-License-Identifier: LGPL-2.1-or-later
// The links of a simulation, and the packets on them.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "src/link/bottleneck.h"
#include "src/sim/simulation.h"

namespace lidar::scream::test {

struct WirePacket {
  int flow = 0;
  int source = 0;
  std::uint32_t ssrc = 0;
  std::uint16_t seq = 0;
  std::size_t frame = 0;  // index of the frame in its flow
  bool marker = false;
  DataSize size;
  std::vector<std::uint8_t> report{};  // bytes of a receiver's report; empty for media packets
  const Route* route = nullptr;        // outlives the packet
  std::size_t hop = 0;                 // index of the current link in `route`
  Time sent{};
  Duration sojourn{0};  // time in queues so far
};

class Network {
 public:
  explicit Network(const SimulationConfig& config) {
    links_.emplace_back(config.forward);
    for (const link::BottleneckConfig& link : config.more_links) links_.emplace_back(link);
  }

  void Send(Time now, Ecn ecn, const Route& route, WirePacket packet) {
    packet.route = &route;
    packet.sent = now;
    links_[route.front()].Enqueue(now, {packet.size, ecn, wire_.size()});
    wire_.push_back(std::move(packet));
  }

  Time NextEventTime() const {
    Time next = Time::max();
    for (const link::Bottleneck& link : links_) next = std::min(next, link.NextEventTime());
    return next;
  }

  /// Returns the packets that have left their last link, or were lost, up to `now`.
  std::vector<link::Outcome> Deliver(Time now) {
    std::vector<link::Outcome> out;
    for (link::Bottleneck& link : links_) {
      for (const link::Outcome& o : link.Deliver(now)) {
        WirePacket& packet = wire_[o.packet.id];
        packet.sojourn += o.sojourn;
        if (o.delivered() && packet.hop + 1 < packet.route->size())
          links_[(*packet.route)[++packet.hop]].Enqueue(now, o.packet);
        else
          out.push_back(o);
      }
    }
    return out;
  }

  const WirePacket& packet(std::uint64_t id) const { return wire_[id]; }

 private:
  std::deque<link::Bottleneck> links_;
  std::vector<WirePacket> wire_;
};

}  // namespace lidar::scream::test
