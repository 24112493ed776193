// SPDX-License-Identifier: LGPL-2.1-or-later
// Decides from which peer the receiver accepts packets.
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

/// Digests of the latest packets. A search removes the digest that it finds.
template <std::size_t size>
class Digests {
 public:
  void Add(std::uint64_t digest) { values_[next_++ % size] = digest; }
  bool Take(std::uint64_t digest) {
    for (std::uint64_t& value : values_) {
      if (value != digest) continue;
      value = 0;
      return true;
    }
    return false;
  }

 private:
  std::array<std::uint64_t, size> values_{};
  std::size_t next_ = 0;
};

/// Accepts one peer at a time: the first that sends. Another peer takes its place with a higher
/// standing (see Standing), or with an equal one while the first is silent. Packets of other peers
/// are dropped, but count for their standing. A packet without an address counts as the peer's.
///
/// A peer may send over several links. An address becomes its link after kCopies packets that equal
/// packets of the peer byte for byte: only an observer of the packets can send them. If a link
/// falls silent, the peer continues over the others.
class PeerLatch {
 public:
  /// A stream is a packet and this many more with ascending numbers in their SSRC.
  static constexpr int kProbation = 4;
  /// Time within which the packets of a stream arrive.
  static constexpr Duration kStreamTime = 1s;
  /// For this time after its first packet, the accepted peer counts at least as a stream.
  static constexpr Duration kStart = 200ms;
  /// An accepted peer is silent after this time without packets.
  static constexpr Duration kPeerSilence = 500ms;
  /// Silence after which a mere stream can take the place of a peer with slices.
  static constexpr Duration kLongSilence = 5s;
  /// Time for which the SSRCs of a silent peer stay known.
  static constexpr Duration kStandingMemory = 10min;
  static constexpr std::size_t kMaxCandidates = 64;
  /// An address that sends this many copies of the peer's packets becomes a link of the peer.
  static constexpr int kCopies = 4;
  static constexpr std::size_t kMaxLinks = 4;

  /// The evidence for a peer, in ascending order.
  enum class Standing {
    kNothing,
    kStream,  ///< sends a stream now
    kSlices,  ///< a whole slice was assembled from its LiDAR packets
    kKnown,   ///< continues an SSRC of a silent peer that showed slices
  };
  enum class Verdict {
    kAccepted,
    kMoved,    ///< accepted from a new peer: the state of the old one is void
    kForeign,  ///< not the peer's
  };
  struct Packet {
    GSocketAddress* from = nullptr;  // NULL: unknown
    std::uint32_t ssrc = 0;
    std::uint16_t seq = 0;
    ByteView lidar{};          // the LiDAR payload, if there is one
    std::uint64_t digest = 0;  // of the whole packet, if WantsDigest()
  };

  Verdict OnPacket(Time now, const Packet& packet);
  /// Returns true for an address of the peer, which may send datagrams other than media.
  bool IsPeer(GSocketAddress* from) const;
  /// Returns true if OnPacket() does not need the payload of packets from `from`.
  bool HasShownSlices(GSocketAddress* from) const { return peer_.has_slices && IsPeer(from); }
  /// Returns true if another address sends, too, so that a packet may be a copy.
  bool WantsDigest(GSocketAddress* from) const {
    return !candidates_.empty() || !links_.empty() || !IsPeer(from);
  }
  /// Number of links of the peer, the first one included.
  std::size_t links() const { return latched_ ? 1 + links_.size() : 0; }
  /// Address of link `n`, owned by the latch; peer() for 0.
  GSocketAddress* link(std::size_t n) const {
    return n == 0 ? peer() : links_[n - 1].address.get();
  }
  /// NULL before the first packet with an address; owned by the latch.
  GSocketAddress* peer() const { return peer_.address.get(); }
  /// Begins a session. SSRCs with whole slices stay known from the last session.
  void Restart();

 private:
  /// State of an SSRC.
  struct Source {
    std::uint16_t next_seq = 0;
    Time at{};
  };
  using Sources = std::map<std::uint32_t, Source>;
  struct Peer {
    SocketAddressPtr address;
    Sources sources;
    std::array<Time, kProbation> last{};  // times of the latest packets with ascending numbers
    int went_on = 0;                      // number of such packets, up to kProbation
    Time since{};
    Time at{};
    bool has_slices = false;
    bool is_known = false;
    rtp::UnitCheck check;
    Digests<64> digests;  // of packets that the peer has not sent yet
    int copies = 0;

    void Add(Time now, const Packet& packet);
    Standing standing(Time now) const;
  };

  /// A link other than the first.
  struct Link {
    SocketAddressPtr address;
    Time at{};
  };

  Link* LinkOf(GSocketAddress* from);
  Verdict OnLinkPacket(Time now, const Packet& packet, Link* link);
  void NoteCopies(const Packet& packet);
  bool Join(Time now, Peer* candidate);
  Peer& CandidateOf(Time now, GSocketAddress* from);
  /// Time of the last packet by any link.
  Time LastHeard() const;
  bool IsSilent(Time now) const { return now - LastHeard() >= kPeerSilence; }
  void Remember(const Peer& peer);
  bool IsKnown(Time now, const Packet& packet) const;
  bool Wins(const Peer& candidate, Time now) const;
  void Promote(Time now, Peer candidate);

  bool latched_ = false;
  Peer peer_;
  std::vector<Peer> candidates_;
  std::vector<Link> links_;
  Digests<512> digests_;  // of packets of the peer
  Sources known_;         // of silent peers that had shown slices
};

}  // namespace lidar::gst
