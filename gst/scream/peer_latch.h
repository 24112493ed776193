// SPDX-License-Identifier: LGPL-2.1-or-later
// The peer whose packets the receiver accepts.
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

/// The latest digests of packets; each is found once.
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

/// Accepts a single peer at a time: the first that sends. Another takes its place with a higher
/// standing (see Standing), or with an equal one while the first is silent. Packets of others count
/// towards their standing and are dropped. A packet without an address belongs to any peer.
///
/// A peer may send over several links. An address joins it by copies: kCopies packets that are
/// equal, byte for byte, to packets of the peer, which only an observer of the packets can send. If
/// a link falls silent, the peer goes on over the others.
class PeerLatch {
 public:
  /// A stream is this many packets after the first, each further on in its SSRC...
  static constexpr int kProbation = 4;
  /// ...within this time.
  static constexpr Duration kStreamTime = 1s;
  /// For so long after its first packet a peer counts as a stream.
  static constexpr Duration kStart = 200ms;
  /// An accepted peer without packets for this long is silent.
  static constexpr Duration kPeerSilence = 500ms;
  /// Silence after which a stream is enough to follow a peer that had shown slices.
  static constexpr Duration kLongSilence = 5s;
  /// SSRCs of a peer that fell silent are known for so long.
  static constexpr Duration kStandingMemory = 10min;
  static constexpr std::size_t kMaxCandidates = 64;
  /// So many copies make an address a link of the peer.
  static constexpr int kCopies = 4;
  static constexpr std::size_t kMaxLinks = 4;

  /// The evidence for a peer, in the order of its weight.
  enum class Standing {
    kNothing,
    kStream,  ///< sends a stream now
    kSlices,  ///< a slice of its LiDAR packets came out whole
    kKnown,   ///< continues an SSRC of a silent peer's slices
  };
  enum class Verdict {
    kAccepted,
    kMoved,    ///< accepted, from a new peer: what was known of the old one is void
    kForeign,  ///< not from the peer
  };
  struct Packet {
    GSocketAddress* from = nullptr;  // NULL: unknown
    std::uint32_t ssrc = 0;
    std::uint16_t seq = 0;
    ByteView lidar{};          // the payload, where it is a LiDAR payload
    std::uint64_t digest = 0;  // of all its bytes, where WantsDigest() says so
  };

  Verdict OnPacket(Time now, const Packet& packet);
  /// Returns true if a datagram that is no media may be accepted.
  bool IsPeer(GSocketAddress* from) const;
  /// Returns true if OnPacket() does not need the payload of packets from there.
  bool HasShownSlices(GSocketAddress* from) const { return peer_.has_slices && IsPeer(from); }
  /// Returns true if copies are possible: another address sends too.
  bool WantsDigest(GSocketAddress* from) const {
    return !candidates_.empty() || !links_.empty() || !IsPeer(from);
  }
  /// Links of the peer, the first one included.
  std::size_t links() const { return latched_ ? 1 + links_.size() : 0; }
  /// Address of link `n`, not owned by the caller; as peer() for 0.
  GSocketAddress* link(std::size_t n) const {
    return n == 0 ? peer() : links_[n - 1].address.get();
  }
  /// NULL before the first packet with an address; not owned by the caller.
  GSocketAddress* peer() const { return peer_.address.get(); }
  /// Begins a session. The SSRCs whose slices came out whole stay known from the one before.
  void Restart();

 private:
  /// The state of an SSRC.
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
    Time since{};
    Time at{};
    bool has_slices = false;
    bool is_known = false;
    rtp::UnitCheck check;
    Digests<64> digests;  // of what the peer has not sent yet
    int copies = 0;

    void Add(Time now, const Packet& packet);
    Standing standing(Time now) const;
  };

  /// A link beside the first.
  struct Link {
    SocketAddressPtr address;
    Time at{};
  };

  Link* LinkOf(GSocketAddress* from);
  Verdict OnLinkPacket(Time now, const Packet& packet, Link* link);
  void NoteCopies(const Packet& packet);
  bool Join(Time now, Peer* candidate);
  Peer& CandidateOf(Time now, GSocketAddress* from);
  /// When a packet came last, by any link.
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
  Digests<512> digests_;  // of what the peer sent
  Sources known_;         // of peers that had shown slices and fell silent
};

}  // namespace lidar::gst
