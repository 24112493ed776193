// SPDX-License-Identifier: LGPL-2.1-or-later
// A UDP relay that damages or drops packets on request. For each slice it records whether all
// packets of the slice passed.
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

/// The faults of the link. A fraction is from 0 to 1.
struct Fault {
  double loss = 0;             // fraction of media packets that are dropped
  double duplicate = 0;        // fraction of media packets that are sent twice
  double feedback_loss = 0;    // fraction of feedback packets that are dropped
  unsigned reorder_by = 0;     // every 50th packet is sent this many packets later
  std::size_t mtu = 65'535;    // larger datagrams are dropped [bytes of UDP payload]
  double damage = 0;           // fraction of media packets in which a bit is changed
  unsigned garbage_ratio = 0;  // number of garbage packets per media packet
  bool valid_garbage = false;  // whether garbage looks like RTP with the payload type of media
  double mark = 0;             // fraction of media packets with ECT that are marked CE
  bool down = false;           // whether all packets are dropped, in both directions
};

/// The key of a slice: the SSRC of its sender, its scan number and its index.
struct SliceKey {
  std::uint32_t ssrc;
  std::uint32_t scan_number;
  std::uint16_t index;
  bool operator<(const SliceKey& o) const {
    return std::tie(ssrc, scan_number, index) < std::tie(o.ssrc, o.scan_number, o.index);
  }
};

struct LinkCounts {
  std::uint64_t packets = 0;  // media packets
  std::uint64_t dropped = 0;
  std::uint64_t garbage = 0;
  std::uint64_t slices = 0;
  std::uint64_t slices_whole = 0;  // slices whose packets all passed unchanged
};

/// Relays media packets from 127.0.0.1:port() to 127.0.0.1:`receiver_port`, including their ECN
/// bits. Relays feedback packets to the address that sent the last media packet. Runs in a thread
/// of its own.
class FaultLink {
 public:
  explicit FaultLink(std::uint16_t receiver_port, unsigned seed = 1);
  ~FaultLink();
  FaultLink(const FaultLink&) = delete;
  FaultLink& operator=(const FaultLink&) = delete;

  std::uint16_t port() const { return port_; }
  void Set(const Fault& fault);
  /// Puts a bottleneck with a queue into the path of media. Its capacity follows the trace (see
  /// link::Capacity::ParseTrace), which begins now. After the end of the trace its last rate
  /// remains. The queue marks packets, and has no limit at which it drops them.
  void SetCapacity(const std::string& trace);
  /// Sends media from another source port from now on, as happens after NAT rebinding.
  void Rebind();
  /// Sends media to another port of 127.0.0.1 from now on, as happens after a change of routes.
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
  std::unique_ptr<link::Bottleneck> bottleneck_;  // null if the capacity is unlimited

  // The members below belong to the thread of the link. Other threads access only the atomic
  // members, and read port_, which does not change.
  std::map<std::uint64_t, Datagram> queued_;  // by the id of the packet in the bottleneck
  std::uint64_t next_id_ = 0;
  std::atomic<std::uint16_t> receiver_port_;
  std::uint16_t port_ = 0;
  int in_ = -1;
  int out_ = -1;
  std::uint16_t sender_port_ = 0;
  // A packet that is sent later, and the number of packets to send before it.
  std::optional<std::pair<Datagram, unsigned>> held_;
  unsigned until_hold_ = 50;
  std::mt19937 random_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace lidar::test
