// SPDX-License-Identifier: LGPL-2.1-or-later
// A path model that receives reports directly, without a simulated link and sender.
#pragma once
#include "src/scream/model/path_model.h"
#include "src/sim/simulated_time.h"

namespace lidar::scream {

constexpr Duration kRtt = 40ms;
constexpr DataSize kPacket = DataSize::Bytes(1000);

/// Arrive() reports packets that arrive `spacing` apart and waited in a queue for `queue`.
class Path {
 public:
  explicit Path(const Parameters& parameters) : model(parameters) {
    AckSummary first;
    first.rtt = kRtt;
    model.OnRoundTrip(kStart, first);
    Arrive(1, Duration{0}, Duration{0}, Ecn::kEct1);
  }
  void Arrive(int packets, Duration spacing, Duration queue, Ecn ecn) {
    for (int i = 0; i < packets; ++i) {
      now += spacing;
      AckSummary acks;
      acks.rtt = kRtt + queue;
      model.OnRoundTrip(now, acks);
      AckedPacket packet;
      packet.size = kPacket;
      packet.ecn = Ecn::kEct1;
      packet.arrived_ecn = ecn;
      packet.sent = now - kRtt - queue;
      packet.arrival = now - kRtt / 2;
      acks.report = *packet.arrival;
      acks.acked.push_back(packet);
      acks.bytes_newly_acked = kPacket;
      model.OnReport(now, acks, {DataSize::Bytes(10000), 20ms});
    }
  }
  PathModel model;
  Time now = kStart;
};

}  // namespace lidar::scream
