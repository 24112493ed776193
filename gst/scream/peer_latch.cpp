// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/peer_latch.h"

#include <algorithm>
#include <utility>

#include "src/base/sequence.h"

namespace lidar::gst {
namespace {

// A sender that gets no feedback any more drops most of what it has: few packets come, with gaps.
constexpr int kMaxGap = 500;
// A sender that moved may have lost much on the way.
constexpr int kMaxKnownGap = 1 << 14;
constexpr std::size_t kMostSources = 64;

bool GoesOn(std::uint16_t seq, std::uint16_t next_seq, int max_gap) {
  const int distance = SequenceDistance(seq, next_seq);
  return distance >= 0 && distance < max_gap;
}

SocketAddressPtr Ref(GSocketAddress* address) {
  return SocketAddressPtr(address != nullptr ? G_SOCKET_ADDRESS(g_object_ref(address)) : nullptr);
}

}  // namespace

void PeerLatch::Peer::Add(Time now, const Packet& packet) {
  at = now;
  const auto found = sources.find(packet.ssrc);
  const bool goes_on =
      found != sources.end() && GoesOn(packet.seq, found->second.next_seq, kMaxGap);
  if (goes_on) {
    std::rotate(last.begin(), last.begin() + 1, last.end());
    last.back() = now;
    went_on = std::min(went_on + 1, kProbation);
  }
  // An SSRC that went back stays where it was for a while, or a repeated packet would be a stream.
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
  return latched_ && (from == nullptr || !peer_.address || SameAddress(from, peer_.address.get()));
}

/// Where all places are taken, the candidate goes that has shown least and was silent for longest.
PeerLatch::Peer& PeerLatch::CandidateOf(Time now, GSocketAddress* from) {
  for (Peer& c : candidates_)
    if (SameAddress(c.address.get(), from)) return c;
  if (candidates_.size() >= kMaxCandidates)
    candidates_.erase(std::min_element(
        candidates_.begin(), candidates_.end(), [now](const Peer& a, const Peer& b) {
          return std::pair(a.standing(now), a.at) < std::pair(b.standing(now), b.at);
        }));
  candidates_.emplace_back().address = Ref(from);
  return candidates_.back();
}

/// Whether the packet goes on with an SSRC of a peer that is silent. While the believed peer sends,
/// its SSRCs are its own.
bool PeerLatch::IsKnown(Time now, const Packet& packet) const {
  const auto goes_on = [&](const Sources& sources) {
    const auto found = sources.find(packet.ssrc);
    return found != sources.end() && now - found->second.at <= kMemory &&
           GoesOn(packet.seq, found->second.next_seq, kMaxKnownGap);
  };
  return goes_on(known_) || (peer_.has_slices && IsSilent(now) && goes_on(peer_.sources));
}

bool PeerLatch::Wins(const Peer& candidate, Time now) const {
  if (candidate.went_on < kProbation) return false;
  const Standing shown = candidate.standing(now);
  if (!IsSilent(now)) return shown > peer_.standing(now);
  const bool needs_slices = peer_.has_slices && now - peer_.at < kLongSilence;
  return shown >= (needs_slices ? Standing::kSlices : Standing::kStream);
}

/// What fell silent stays known; what was outweighed while it sent is forgotten.
void PeerLatch::Promote(Time now, Peer candidate) {
  if (IsSilent(now) && peer_.has_slices)
    for (const auto& [ssrc, source] : peer_.sources) known_[ssrc] = source;
  for (auto it = known_.begin(); it != known_.end();) {
    const bool old = now - it->second.at > kMemory || candidate.sources.count(it->first) > 0;
    it = old ? known_.erase(it) : std::next(it);
  }
  while (known_.size() > kMostSources) known_.erase(known_.begin());
  candidate.has_slices = candidate.has_slices || candidate.is_known;
  peer_ = std::move(candidate);
  candidates_.erase(std::remove_if(candidates_.begin(), candidates_.end(),
                                   [](const Peer& c) { return c.address == nullptr; }),
                    candidates_.end());
}

PeerLatch::Verdict PeerLatch::OnPacket(Time now, const Packet& packet) {
  if (!latched_ || IsPeer(packet.from)) {
    latched_ = true;
    // The next packet then compares by pointer.
    if (packet.from != nullptr && packet.from != peer_.address.get())
      peer_.address = Ref(packet.from);
    peer_.Add(now, packet);
    return Verdict::kAccepted;
  }
  Peer& candidate = CandidateOf(now, packet.from);
  candidate.is_known = candidate.is_known || IsKnown(now, packet);
  candidate.Add(now, packet);
  if (!Wins(candidate, now)) return Verdict::kForeign;
  Promote(now, std::move(candidate));
  return Verdict::kMoved;
}

}  // namespace lidar::gst
