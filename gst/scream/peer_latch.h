// SPDX-License-Identifier: LGPL-2.1-or-later
// Whose packets the receiver believes.
#pragma once
#include <gio/gio.h>

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "gst/net/udp_socket.h"
#include "src/base/byte_reader.h"
#include "src/base/time.h"
#include "src/rtp/unit_check.h"

namespace lidar::gst {
using namespace std::chrono_literals;

/// One peer at a time is believed: the first that sends. Another takes its place when it has more
/// to show for itself (see Standing), or as much while the first is silent. All that others send
/// counts towards their standing and is dropped. A packet without an address (from an element that
/// does not tell) belongs to any peer.
class PeerLatch {
 public:
  /// A stream is this many packets after the first, each further on in its SSRC...
  static constexpr int kProbation = 4;
  /// ...within this time.
  static constexpr Duration kStreamTime = 1s;
  /// A believed peer without packets for so long is silent.
  static constexpr Duration kSilence = 500ms;
  /// After this silence a stream is enough to follow a peer that had shown slices.
  static constexpr Duration kLongSilence = 5s;
  /// SSRCs of a peer that fell silent are known for so long.
  static constexpr Duration kMemory = 10min;
  static constexpr std::size_t kMaxCandidates = 64;

  /// What a peer has shown, in the order of its weight.
  enum class Standing {
    kNothing,
    kStream,  ///< sends a stream now
    kSlices,  ///< of its LiDAR packets a slice came out whole
    kKnown,   ///< goes on with an SSRC whose slices did, where the peer that had it fell silent
  };
  enum class Verdict {
    kAccepted,
    kMoved,    ///< accepted, from a new peer: what was known of the old one is void
    kForeign,  ///< not from the peer
  };
  struct Packet {
    GSocketAddress* from = nullptr;  // NULL: not told
    std::uint32_t ssrc = 0;
    std::uint16_t seq = 0;
    ByteView lidar{};  // the payload, where it is a LiDAR payload
  };

  Verdict OnPacket(Time now, const Packet& packet);
  /// True where a datagram that is no media may be believed.
  bool IsPeer(GSocketAddress* from) const;
  /// True where OnPacket() has no use for the payload of what comes from there.
  bool HasShownSlices(GSocketAddress* from) const { return peer_.has_slices && IsPeer(from); }
  /// NULL before the first packet, or where no packet had an address; not owned by the caller.
  GSocketAddress* peer() const { return peer_.address.get(); }
  void Reset() { *this = PeerLatch(); }

 private:
  /// How far an SSRC has come.
  struct Source {
    std::uint16_t next_seq = 0;
    Time at{};
  };
  using Sources = std::map<std::uint32_t, Source>;
  struct Peer {
    SocketAddressPtr address;
    Sources sources;
    std::array<Time, kProbation> last{};  // when the latest packets that went on came
    int went_on = 0;                      // packets, up to kProbation
    Time at{};
    bool has_slices = false;
    bool is_known = false;
    rtp::UnitCheck check;

    void Add(Time now, const Packet& packet);
    Standing standing(Time now) const;
  };

  Peer& CandidateOf(Time now, GSocketAddress* from);
  bool IsSilent(Time now) const { return now - peer_.at >= kSilence; }
  bool IsKnown(Time now, const Packet& packet) const;
  bool Wins(const Peer& candidate, Time now) const;
  void Promote(Time now, Peer candidate);

  bool latched_ = false;
  Peer peer_;
  std::vector<Peer> candidates_;
  Sources known_;  // of peers that had shown slices and fell silent
};

}  // namespace lidar::gst
