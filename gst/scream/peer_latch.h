// SPDX-License-Identifier: LGPL-2.1-or-later
// Whose packets the receiver believes: the first peer's, until it is silent and another has shown
// that it sends a stream.
#pragma once
#include <gio/gio.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "gst/net/udp_socket.h"
#include "src/base/time.h"

namespace lidar::gst {
using namespace std::chrono_literals;

/// A packet without an address (from an element that does not tell) belongs to any peer.
class PeerLatch {
 public:
  /// A new peer is believed after this many packets of one SSRC in sequence...
  static constexpr int kProbation = 5;
  /// ...and this silence of the old one.
  static constexpr Duration kSilence = 500ms;

  enum class Verdict {
    kAccepted,
    kMoved,    ///< accepted, from a new peer: what was known of the old one is void
    kForeign,  ///< not from the peer
  };

  Verdict OnPacket(Time now, GSocketAddress* from, std::uint32_t ssrc, std::uint16_t seq);
  /// True where a datagram that is no media may be believed.
  bool IsPeer(GSocketAddress* from) const;
  /// NULL before the first packet, or where no packet had an address; not owned by the caller.
  GSocketAddress* peer() const { return peer_.get(); }
  void Reset() { *this = PeerLatch(); }

 private:
  using Address = std::unique_ptr<GSocketAddress, GObjectUnref>;
  struct Candidate {
    Address address;
    std::uint32_t ssrc = 0;
    std::uint16_t next_seq = 0;
    int in_sequence = 0;
  };
  void Latch(Time now, GSocketAddress* from);

  Address peer_;
  bool latched_ = false;
  Time last_{};
  Candidate candidate_;
};

}  // namespace lidar::gst
