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

/// Stores the digests of the last `size` packets. Take() removes the digest that it finds.
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

/// Accepts packets from one peer at a time. The first peer that sends is accepted. Another peer
/// replaces it if the evidence for the other peer (see Standing) is stronger. While the accepted
/// peer is silent, whole slices are enough evidence. A mere stream is then enough if the accepted
/// peer has sent no whole slice or has been silent for kLongSilence. Packets of other peers are
/// dropped, but count as evidence for these peers. A packet without a source address counts as a
/// packet of the accepted peer.
///
/// A peer may send over several links, each with its own address. An address becomes a link of the
/// peer after it has sent kCopies packets that are equal, byte for byte, to packets of the peer.
/// Another host could send such copies only if it saw the peer's packets. If one link falls silent,
/// the packets of the other links are still accepted.
class PeerLatch {
 public:
  /// The number of packets that must continue the sequence numbers of an SSRC, after its first
  /// packet, before the peer counts as sending a stream.
  static constexpr int kProbation = 4;
  /// The time within which the kProbation packets of a stream must arrive.
  static constexpr Duration kStreamTime = 1s;
  /// For this time after its first packet, the accepted peer has at least the standing kStream.
  static constexpr Duration kStart = 200ms;
  /// The accepted peer is silent if no packet of it has arrived for this time.
  static constexpr Duration kPeerSilence = 500ms;
  /// The time of silence after which an accepted peer that has sent whole slices can be replaced by
  /// a peer that only sends a stream.
  static constexpr Duration kLongSilence = 5s;
  /// The SSRCs of a silent peer are remembered for this time.
  static constexpr Duration kStandingMemory = 10min;
  static constexpr std::size_t kMaxCandidates = 64;
  /// An address that sends this many copies of the peer's packets becomes a link of the peer.
  static constexpr int kCopies = 4;
  static constexpr std::size_t kMaxLinks = 4;

  /// The evidence that a peer is the wanted sender, from weakest to strongest.
  enum class Standing {
    kNothing,
    kStream,  ///< sends a stream now
    kSlices,  ///< a whole slice was assembled from its LiDAR packets
    kKnown,   ///< its packets continue an SSRC of a silent peer that had sent whole slices
  };
  enum class Verdict {
    kAccepted,
    kMoved,    ///< accepted from a new peer; the caller discards its state of the old peer
    kForeign,  ///< not from the accepted peer
  };
  struct Packet {
    GSocketAddress* from = nullptr;  // NULL: unknown
    std::uint32_t ssrc = 0;
    std::uint16_t seq = 0;
    ByteView lidar{};          // the LiDAR payload, if there is one
    std::uint64_t digest = 0;  // of the whole packet if WantsDigest(), else 0
  };

  Verdict OnPacket(Time now, const Packet& packet);
  /// Returns true if `from` is an address of the accepted peer. This also permits datagrams that
  /// are not media.
  bool IsPeer(GSocketAddress* from) const;
  /// Returns true if OnPacket() does not need the payload of packets from `from`, because this peer
  /// has already sent a whole slice.
  bool HasShownSlices(GSocketAddress* from) const { return peer_.has_slices && IsPeer(from); }
  /// Returns true if several addresses send. A packet may then be a copy of another, and OnPacket()
  /// needs its digest.
  bool WantsDigest(GSocketAddress* from) const {
    return !candidates_.empty() || !links_.empty() || !IsPeer(from);
  }
  /// Returns the number of links of the accepted peer, including its first link.
  std::size_t links() const { return latched_ ? 1 + links_.size() : 0; }
  /// Returns the address of link `n`, or peer() if `n` is 0. The latch owns the address.
  GSocketAddress* link(std::size_t n) const {
    return n == 0 ? peer() : links_[n - 1].address.get();
  }
  /// Returns the address of the first link, or NULL before the first packet with an address. The
  /// latch owns the address.
  GSocketAddress* peer() const { return peer_.address.get(); }
  /// Begins a new session, without an accepted peer. The SSRCs of the last peer are remembered if
  /// it had sent whole slices.
  void Restart();

 private:
  /// The next expected sequence number of an SSRC, and the time of its last packet.
  struct Source {
    std::uint16_t next_seq = 0;
    Time at{};
  };
  using Sources = std::map<std::uint32_t, Source>;
  struct Peer {
    SocketAddressPtr address;
    Sources sources;
    std::array<Time, kProbation> last{};  // times of the latest packets with ascending numbers
    int went_on = 0;                      // packets with ascending numbers, up to kProbation
    Time since{};
    Time at{};
    bool has_slices = false;
    bool is_known = false;
    rtp::UnitCheck check;
    Digests<64> digests;  // of a candidate's packets that the accepted peer has not sent yet
    int copies = 0;

    void Add(Time now, const Packet& packet);
    Standing standing(Time now) const;
  };

  /// A link of the accepted peer other than its first link.
  struct Link {
    SocketAddressPtr address;
    Time at{};
  };

  Link* LinkOf(GSocketAddress* from);
  Verdict OnLinkPacket(Time now, const Packet& packet, Link* link);
  void NoteCopies(const Packet& packet);
  bool Join(Time now, Peer* candidate);
  Peer& CandidateOf(Time now, GSocketAddress* from);
  /// Returns the time of the last packet that arrived by any link.
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
  Digests<512> digests_;  // of the accepted peer's packets
  Sources known_;         // SSRCs of silent peers that had sent whole slices
};

}  // namespace lidar::gst
