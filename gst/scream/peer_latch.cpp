// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/peer_latch.h"

#include <algorithm>
#include <utility>

#include "src/base/sequence.h"

namespace lidar::gst {
namespace {

// The sequence numbers of a new peer may skip fewer than this many packets. The limit is large
// because a sender that gets no feedback drops most packets.
constexpr int kMaxGap = 500;
// The same limit for the SSRC of a silent peer. It is larger because many packets may be lost while
// a sender moves to another address.
constexpr int kMaxKnownGap = 1 << 14;
constexpr std::size_t kMostSources = 64;

bool GoesOn(std::uint16_t seq, std::uint16_t next_seq, int max_gap) {
  const int distance = SequenceDistance(seq, next_seq);
  return distance >= 0 && distance < max_gap;
}

}  // namespace

void PeerLatch::Peer::Add(Time now, const Packet& packet) {
  if (sources.empty()) since = now;
  at = now;
  const auto found = sources.find(packet.ssrc);
  const bool goes_on =
      found != sources.end() && GoesOn(packet.seq, found->second.next_seq, kMaxGap);
  if (goes_on) {
    std::rotate(last.begin(), last.begin() + 1, last.end());
    last.back() = now;
    went_on = std::min(went_on + 1, kProbation);
  }
  // The expected number of an SSRC steps back only after the SSRC has been silent for kStreamTime.
  // Otherwise a few packets, sent again and again, would count as a stream.
  if (goes_on || found == sources.end() || now - found->second.at > kStreamTime) {
    if (found == sources.end() && sources.size() >= kMostSources) sources.erase(sources.begin());
    sources[packet.ssrc] = {static_cast<std::uint16_t>(packet.seq + 1), now};
  }
  if (!has_slices && packet.lidar.size > 0) has_slices = check.Push(packet.seq, packet.lidar);
}

PeerLatch::Standing PeerLatch::Peer::standing(Time now) const {
  if (is_known) return Standing::kKnown;
  if (has_slices) return Standing::kSlices;
  const bool streams = went_on >= kProbation && now - last.front() <= kStreamTime;
  return streams ? Standing::kStream : Standing::kNothing;
}

bool PeerLatch::IsPeer(GSocketAddress* from) const {
  if (!latched_) return false;
  if (from == nullptr || !peer_.address || SameAddress(from, peer_.address.get())) return true;
  return std::any_of(links_.begin(), links_.end(),
                     [from](const Link& l) { return SameAddress(from, l.address.get()); });
}

PeerLatch::Link* PeerLatch::LinkOf(GSocketAddress* from) {
  for (Link& link : links_)
    if (SameAddress(from, link.address.get())) return &link;
  return nullptr;
}

Time PeerLatch::LastHeard() const {
  Time last = peer_.at;
  for (const Link& link : links_) last = std::max(last, link.at);
  return last;
}

/// Accepts a packet that the peer sent over its further link `link`. If the peer's first link is
/// silent, swaps the two links: only packets of the first link count for the peer's standing (see
/// Standing).
PeerLatch::Verdict PeerLatch::OnLinkPacket(Time now, const Packet& packet, Link* link) {
  link->at = now;
  if (now - peer_.at >= kPeerSilence) {
    std::swap(link->address, peer_.address);
    link->at = peer_.at;
    peer_.Add(now, packet);
  }
  NoteCopies(packet);
  return Verdict::kAccepted;
}

/// Counts the copies of this packet that candidates have sent.
void PeerLatch::NoteCopies(const Packet& packet) {
  if (packet.digest == 0) return;
  digests_.Add(packet.digest);
  for (Peer& c : candidates_)
    if (c.digests.Take(packet.digest)) ++c.copies;
}

/// Makes the candidate a link of the accepted peer. If there are too many links, the candidate
/// replaces the link that has been silent for longest. Returns false if no link is silent.
bool PeerLatch::Join(Time now, Peer* candidate) {
  if (links_.size() + 1 >= kMaxLinks) {
    const auto oldest = std::min_element(links_.begin(), links_.end(),
                                         [](const Link& a, const Link& b) { return a.at < b.at; });
    if (now - oldest->at < kPeerSilence) return false;
    links_.erase(oldest);
  }
  links_.push_back({std::move(candidate->address), now});
  candidates_.erase(std::remove_if(candidates_.begin(), candidates_.end(),
                                   [](const Peer& c) { return c.address == nullptr; }),
                    candidates_.end());
  return true;
}

/// Returns the candidate with the address `from`, which is added if there is none. If there are too
/// many candidates, the new one replaces the candidate with the lowest standing. Among candidates
/// of equal standing, it replaces the candidate that has been silent for longest.
PeerLatch::Peer& PeerLatch::CandidateOf(Time now, GSocketAddress* from) {
  for (Peer& c : candidates_)
    if (SameAddress(c.address.get(), from)) return c;
  if (candidates_.size() >= kMaxCandidates)
    candidates_.erase(std::min_element(
        candidates_.begin(), candidates_.end(), [now](const Peer& a, const Peer& b) {
          return std::pair(a.standing(now), a.at) < std::pair(b.standing(now), b.at);
        }));
  candidates_.emplace_back().address = RefAddress(from);
  return candidates_.back();
}

void PeerLatch::Remember(const Peer& peer) {
  if (!peer.has_slices) return;
  for (const auto& [ssrc, source] : peer.sources) known_[ssrc] = source;
}

void PeerLatch::Restart() {
  PeerLatch next;
  Remember(peer_);
  next.known_ = std::move(known_);
  *this = std::move(next);
}

/// Returns true if the packet continues an SSRC of a silent peer. A packet that continues an SSRC
/// of a peer that still sends does not count.
bool PeerLatch::IsKnown(Time now, const Packet& packet) const {
  const auto goes_on = [&](const Sources& sources) {
    const auto found = sources.find(packet.ssrc);
    return found != sources.end() && now - found->second.at <= kStandingMemory &&
           GoesOn(packet.seq, found->second.next_seq, kMaxKnownGap);
  };
  return goes_on(known_) || (peer_.has_slices && IsSilent(now) && goes_on(peer_.sources));
}

bool PeerLatch::Wins(const Peer& candidate, Time now) const {
  if (candidate.went_on < kProbation) return false;
  const Standing shown = candidate.standing(now);
  // During kStart after the peer's first packet, a stream is not enough to replace the peer,
  // because the stream may be another link of the same sender.
  const Standing least = now - peer_.since < kStart ? Standing::kStream : Standing::kNothing;
  if (!IsSilent(now)) return shown > std::max(peer_.standing(now), least);
  const bool needs_slices = peer_.has_slices && now - LastHeard() < kLongSilence;
  return shown >= (needs_slices ? Standing::kSlices : Standing::kStream);
}

/// Makes the candidate the accepted peer. Remembers the SSRCs of the old peer only if the old peer
/// is silent.
void PeerLatch::Promote(Time now, Peer candidate) {
  if (IsSilent(now)) Remember(peer_);
  for (auto it = known_.begin(); it != known_.end();) {
    const bool old =
        now - it->second.at > kStandingMemory || candidate.sources.count(it->first) > 0;
    it = old ? known_.erase(it) : std::next(it);
  }
  while (known_.size() > kMostSources) known_.erase(known_.begin());
  candidate.has_slices = candidate.has_slices || candidate.is_known;
  links_.clear();
  digests_ = {};
  peer_ = std::move(candidate);
  candidates_.erase(std::remove_if(candidates_.begin(), candidates_.end(),
                                   [](const Peer& c) { return c.address == nullptr; }),
                    candidates_.end());
}

PeerLatch::Verdict PeerLatch::OnPacket(Time now, const Packet& packet) {
  if (packet.from != nullptr && !links_.empty())
    if (Link* link = LinkOf(packet.from)) return OnLinkPacket(now, packet, link);
  if (!latched_ || IsPeer(packet.from)) {
    if (!std::exchange(latched_, true) && IsKnown(now, packet)) {
      peer_.is_known = peer_.has_slices = true;
      known_.erase(packet.ssrc);
    }
    // Keeps the packet's address object, because SameAddress() is fast if the next packet has the
    // same object.
    if (packet.from != nullptr && packet.from != peer_.address.get())
      peer_.address = RefAddress(packet.from);
    peer_.Add(now, packet);
    NoteCopies(packet);
    return Verdict::kAccepted;
  }
  Peer& candidate = CandidateOf(now, packet.from);
  candidate.is_known = candidate.is_known || IsKnown(now, packet);
  candidate.Add(now, packet);
  if (packet.digest != 0 && digests_.Take(packet.digest))
    ++candidate.copies;
  else if (packet.digest != 0)
    candidate.digests.Add(packet.digest);
  if (candidate.copies >= kCopies && Join(now, &candidate)) return Verdict::kAccepted;
  if (!Wins(candidate, now)) return Verdict::kForeign;
  Promote(now, std::move(candidate));
  return Verdict::kMoved;
}

}  // namespace lidar::gst
