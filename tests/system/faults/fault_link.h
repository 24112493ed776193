// SPDX-License-Identifier: LGPL-2.1-or-later
// A UDP relay that damages what it carries on request, and notes for each slice whether all of it
// passed.
#pragma once
#include <netinet/in.h>

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "src/link/bottleneck.h"
#include "src/rtp/payload_header.h"
#include "tests/support/free_ports.h"

namespace lidar::test {

/// The faults of the link.
struct Fault {
  double loss = 0;             // part of the media packets
  double duplicate = 0;        // part of the media packets
  double feedback_loss = 0;    // part of the packets back
  unsigned reorder_by = 0;     // every 50th packet comes this many packets late
  std::size_t mtu = 65'535;    // larger datagrams are dropped [bytes of UDP payload]
  double damage = 0;           // part of the media packets that get a wrong bit
  unsigned garbage_ratio = 0;  // packets of garbage for each media packet
  bool valid_garbage = false;  // garbage that looks like RTP of our payload type
  double mark = 0;             // part of the media packets that get CE, where they have ECT
  bool down = false;           // nothing passes either way
};

/// A slice: the SSRC of its sender, its scan number and its index.
struct SliceKey {
  std::uint32_t ssrc;
  std::uint32_t scan_number;
  std::uint16_t index;
  bool operator<(const SliceKey& o) const {
    return std::tie(ssrc, scan_number, index) < std::tie(o.ssrc, o.scan_number, o.index);
  }
};

struct LinkCounts {
  std::uint64_t packets = 0;  // of media
  std::uint64_t dropped = 0;
  std::uint64_t garbage = 0;
  std::uint64_t slices = 0;
  std::uint64_t slices_whole = 0;  // passed unchanged
};

/// Relays 127.0.0.1:port() to 127.0.0.1:`receiver_port`, ECN bits included, and feedback back to
/// the address that sent last. Has its own thread.
class FaultLink {
 public:
  explicit FaultLink(std::uint16_t receiver_port, unsigned seed = 1);
  ~FaultLink();
  FaultLink(const FaultLink&) = delete;
  FaultLink& operator=(const FaultLink&) = delete;

  std::uint16_t port() const { return port_; }
  void Set(const Fault& fault);
  /// Puts a queue and a link of this capacity (see link::Capacity::ParseTrace) into the path of
  /// media: it marks, and never drops for lack of room. The trace begins now; its last rate stays.
  void SetCapacity(const std::string& trace);
  /// Media goes on from another source port, as after NAT rebinding.
  void Rebind();
  /// Media goes on to another port of 127.0.0.1, as after a change of routes.
  void MoveReceiver(std::uint16_t port) { receiver_port_ = port; }
  LinkCounts counts() const;

 private:
  struct Datagram {
    std::vector<std::uint8_t> bytes;
    int tos = 0;
  };
  void Run();
  std::optional<Datagram> Receive(int socket, sockaddr_in* from);
  void Send(int socket, const Datagram& datagram, std::uint16_t port);
  void OnMedia(Datagram datagram);
  void Forward(const Datagram& datagram);
  void Send(const Datagram& datagram);
  void Deliver();
  int WaitMs() const;
  void SendGarbage(const Fault& fault, const Datagram& model);
  void Note(const Datagram& datagram, bool hit);
  void Fold(const SliceKey& newest);
  bool Chance(double probability);

  mutable std::mutex mutex_;  // guards fault_, slices_, counts_, rebind_ and bottleneck_
  Fault fault_;
  struct Seen {
    std::set<std::uint16_t> sequences;
    bool starts = false;
    bool ends = false;
    bool hit = false;
    bool IsWhole() const;
  };
  std::map<SliceKey, Seen> slices_;
  LinkCounts counts_;
  bool rebind_ = false;
  std::unique_ptr<link::Bottleneck> bottleneck_;  // null: no limit

  // State of the thread.
  std::map<std::uint64_t, Datagram> queued_;  // by the bottleneck's id
  std::uint64_t next_id_ = 0;
  std::atomic<std::uint16_t> receiver_port_;
  std::uint16_t port_ = 0;
  int in_ = -1;
  int out_ = -1;
  std::uint16_t sender_port_ = 0;
  std::optional<std::pair<Datagram, unsigned>> held_;  // and the packets until it is sent
  unsigned until_hold_ = 50;
  std::mt19937 random_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace lidar::test
