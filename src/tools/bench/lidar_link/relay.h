// SPDX-License-Identifier: LGPL-2.1-or-later
// Moves datagrams between sockets through the link model.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/link/bottleneck.h"
#include "src/tools/bench/lidar_link/options.h"
#include "src/tools/bench/lidar_link/recorder.h"
#include "src/tools/common/event_loop.h"
#include "src/tools/common/udp_socket.h"

namespace lidar::tools {

class Relay {
 public:
  /// The arguments must outlive this object. Throws std::runtime_error if a socket cannot be
  /// opened.
  Relay(const LinkOptions& options, EventLoop* loop, Recorder* recorder);

  /// Sends due packets. Returns the latest time of the next call.
  Time Pump();

  std::vector<int> ListeningPorts() const;
  /// Null before the first packet.
  const link::Bottleneck* there() const { return there_ ? &*there_ : nullptr; }
  Time origin() const { return options_.there.origin; }

 private:
  struct Listener {
    UdpSocket socket;
    Address forward;
  };
  /// A sender, with a socket of its own towards the receiver, as behind a NAT.
  struct Flow {
    std::size_t listener;
    Address client;
    UdpSocket socket;
  };
  struct Slot {
    std::vector<std::uint8_t> payload;
    std::size_t flow = 0;
    std::uint8_t tos = 0;
  };

  void OnMedia(std::size_t listener, const Datagram& datagram);
  void OnFeedback(std::size_t flow, const Datagram& datagram);
  std::optional<std::size_t> FindFlow(std::size_t listener, const Address& client);
  void Start(Time origin);
  void Enqueue(link::Bottleneck* link, Time arrival, const Datagram& datagram, std::size_t flow);
  std::size_t TakeSlot(const Datagram& datagram, std::size_t flow);
  Time ArrivalOf(const Datagram& datagram);
  void Forward(const link::Outcome& outcome, Time now);
  void Return(const link::Outcome& outcome);
  void Release(const link::Outcome& outcome);

  LinkOptions options_;
  EventLoop* loop_;
  Recorder* recorder_;
  std::vector<Listener> listeners_;
  std::vector<Flow> flows_;
  std::vector<Slot> slots_;
  std::vector<std::size_t> free_slots_;
  std::optional<link::Bottleneck> there_;
  link::Bottleneck back_;
  Duration unix_offset_;
  Time newest_;  // the model's time does not go back
};

}  // namespace lidar::tools
