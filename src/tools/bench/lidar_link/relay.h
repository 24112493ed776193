// SPDX-License-Identifier: LGPL-2.1-or-later
// Passes datagrams from one socket to another through the model of the link.
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

  /// Sends the packets that are due. Returns the latest time at which Pump() must be called again.
  Time Pump();

  std::vector<int> ListeningPorts() const;
  /// Returns the link towards the receiver, or null before the first packet.
  const link::Bottleneck* there() const { return there_ ? &*there_ : nullptr; }
  Time origin() const { return options_.there.origin; }

 private:
  struct Listener {
    UdpSocket socket;
    Address forward;
  };
  /// A sender. Its packets are forwarded to the receiver from a socket of their own, as behind a
  /// NAT.
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
  Time newest_;  // newest time so far; the model's time must not go back
};

}  // namespace lidar::tools
