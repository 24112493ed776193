// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/peer_latch.h"

#include "src/base/sequence.h"

namespace lidar::gst {
namespace {

// A sender that gets no feedback any more drops most of what it has: few packets come, with gaps.
constexpr int kMaxGap = 500;

}  // namespace

void PeerLatch::Latch(Time now, GSocketAddress* from) {
  peer_.reset(from != nullptr ? G_SOCKET_ADDRESS(g_object_ref(from)) : nullptr);
  latched_ = true;
  last_ = now;
  candidate_ = {};
}

bool PeerLatch::IsPeer(GSocketAddress* from) const {
  return latched_ && (from == nullptr || !peer_ || SameAddress(from, peer_.get()));
}

PeerLatch::Verdict PeerLatch::OnPacket(Time now, GSocketAddress* from, std::uint32_t ssrc,
                                       std::uint16_t seq) {
  if (!latched_) {
    Latch(now, from);
    return Verdict::kAccepted;
  }
  if (IsPeer(from)) {
    last_ = now;
    if (from != nullptr && !peer_) Latch(now, from);
    // The next packet then compares by pointer.
    if (from != nullptr && from != peer_.get()) peer_.reset(G_SOCKET_ADDRESS(g_object_ref(from)));
    return Verdict::kAccepted;
  }
  Candidate& c = candidate_;
  const bool goes_on = c.in_sequence > 0 && SameAddress(from, c.address.get()) && c.ssrc == ssrc &&
                       SequenceDistance(seq, c.next_seq) >= 0 &&
                       SequenceDistance(seq, c.next_seq) < kMaxGap;
  if (!goes_on) {
    c.address.reset(G_SOCKET_ADDRESS(g_object_ref(from)));
    c.ssrc = ssrc;
    c.in_sequence = 0;
  }
  c.next_seq = static_cast<std::uint16_t>(seq + 1);
  ++c.in_sequence;
  if (c.in_sequence < kProbation || now - last_ < kSilence) return Verdict::kForeign;
  Latch(now, from);
  return Verdict::kMoved;
}

}  // namespace lidar::gst
