// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rtp/receiver.h"

#include <cstdlib>
#include <utility>

#include "src/base/sequence.h"

namespace lidar::rtp {
namespace {

constexpr int kMaxSequenceStep = 64;  // limit between two packets of a candidate
// No sensor turns faster. If the scan numbers of a stream have advanced by more during an outage,
// it is another stream.
constexpr double kMostScansPerSecond = 1'000;
constexpr std::int64_t kScansWithoutClock = 10'000;  // limit if arrival times do not advance

void AddPackets(const Reassembler& r, ReceiverAccounts* sum) {
  sum->packets.invalid += r.packets().invalid;
  sum->packets.duplicate += r.packets().duplicate;
  sum->packets.late += r.packets().late;
  sum->packets.config_damaged += r.packets().config_damaged;
  sum->configs_received += r.configs();
}

void Add(const Reassembler& r, ReceiverAccounts* sum) {
  sum->slices += r.slices();
  AddPackets(r, sum);
}

}  // namespace

std::vector<ReceivedSlice> Receiver::Push(const RtpPacket& packet) {
  ++booked_.packets_received;
  const auto units = ParsePayload(packet.payload);
  if (units.empty()) {
    ++booked_.packets.invalid;
    return {};
  }
  if (!active_) active_.emplace(packet.ssrc, Reassembler(max_reorder_time_));
  std::vector<ReceivedSlice> out;
  Dispatch(packet, units, &out);
  return out;
}

void Receiver::Dispatch(const RtpPacket& packet, const std::vector<Unit>& units,
                        std::vector<ReceivedSlice>* out) {
  if (packet.ssrc == active_->ssrc && active_->reassembler.Continues(units)) {
    active_arrival_ = packet.arrival;
    if (candidate_) candidate_->streak = 0;
    if (candidate_ && candidate_->packets >= kProbationNoClock) DropHeld();
    active_->reassembler.Push(packet, units, out);
    return;
  }
  if (packet.ssrc != active_->ssrc) NoteRival(packet.ssrc);
  // A single complete slice of the candidate is enough, because the slices of a throttled sender
  // are far apart.
  if (packet.ssrc == active_->ssrc && candidate_ && !GoesOnWithCandidate(packet, units) &&
      candidate_->reassembler.has_whole_slice() && CandidateGoesOn(packet.arrival)) {
    Promote(packet.arrival, out);
    Dispatch(packet, units, out);
    return;
  }
  PushToCandidate(packet, units);
  if (CandidateHasWon(packet.arrival)) Promote(packet.arrival, out);
}

/// Discards the slices of the candidate. Packets of the active stream still arrive, so the
/// candidate does not come from a restarted sender of this stream.
void Receiver::DropHeld() {
  if (candidate_->held.empty()) return;
  candidate_->held.clear();
  candidate_->reassembler.JoinAnew(candidate_->last_arrival);
}

/// Counts a packet of another SSRC. If there are too many SSRCs, all counts are reset, so forged
/// SSRCs have no other effect.
void Receiver::NoteRival(std::uint32_t ssrc) {
  if (rivals_.size() >= kMaxRivals && rivals_.count(ssrc) == 0) rivals_.clear();
  if (++rivals_[ssrc] >= kRivalPackets) rival_ = ssrc;
}

bool Receiver::GoesOnWithCandidate(const RtpPacket& packet, const std::vector<Unit>& units) const {
  return candidate_->ssrc == packet.ssrc && candidate_->reassembler.Continues(units) &&
         std::abs(SequenceDistance(packet.sequence, candidate_->last_sequence)) <= kMaxSequenceStep;
}

void Receiver::PushToCandidate(const RtpPacket& packet, const std::vector<Unit>& units) {
  if (!candidate_ || !GoesOnWithCandidate(packet, units)) {
    if (candidate_) booked_.packets.invalid += candidate_->streak;
    candidate_.emplace(packet.ssrc, packet.ssrc == active_->ssrc
                                        ? Reassembler(max_reorder_time_, active_->reassembler)
                                        : Reassembler(max_reorder_time_));
  }
  candidate_->last_sequence = packet.sequence;
  candidate_->last_arrival = packet.arrival;
  ++candidate_->streak;
  ++candidate_->packets;
  candidate_->reassembler.Push(packet, units, &candidate_->held);
}

bool Receiver::CandidateHasWon(Time now) const {
  const bool same = candidate_->ssrc == active_->ssrc;
  const bool silent = now - active_arrival_ >= kSilentStream;
  if (silent && candidate_->reassembler.has_whole_slice() && CandidateGoesOn(now)) return true;
  if (candidate_->streak < kProbation || !candidate_->reassembler.started()) return false;
  return same || silent || candidate_->streak >= kProbationNoClock;
}

/// Returns true if the candidate is the active stream after an outage. Returns false if its sender
/// has restarted.
bool Receiver::CandidateGoesOn(Time now) const {
  if (candidate_->ssrc != active_->ssrc) return false;
  const double most = Seconds(now - active_arrival_) * kMostScansPerSecond;
  return candidate_->reassembler.IsAfter(active_->reassembler,
                                         kScansWithoutClock + static_cast<std::int64_t>(most));
}

void Receiver::Promote(Time now, std::vector<ReceivedSlice>* out) {
  active_->reassembler.Finish();
  for (ReceivedSlice& slice : candidate_->held) out->push_back(std::move(slice));
  if (CandidateGoesOn(now)) {
    ++booked_.outages;
    candidate_->reassembler.GoOn(active_->reassembler, out);
    AddPackets(active_->reassembler, &booked_);
  } else {
    ++booked_.restarts;
    Add(active_->reassembler, &booked_);
    if (candidate_->ssrc == active_->ssrc)
      candidate_->reassembler.StartAnew(active_->reassembler, out);
  }
  active_ = std::move(candidate_);
  active_->held.clear();
  active_arrival_ = active_->last_arrival;
  candidate_.reset();
  rivals_.clear();
  rival_.reset();
}

void Receiver::Finish() {
  if (active_) {
    active_->reassembler.Finish();
    Add(active_->reassembler, &booked_);
  }
  active_.reset();
  candidate_.reset();
  rivals_.clear();
  rival_.reset();
}

void Receiver::set_max_reorder_time(Duration t) {
  max_reorder_time_ = t;
  if (active_) active_->reassembler.set_max_reorder_time(t);
  if (candidate_) candidate_->reassembler.set_max_reorder_time(t);
}

ReceiverAccounts Receiver::accounts() const {
  ReceiverAccounts sum = booked_;
  if (active_) Add(active_->reassembler, &sum);
  return sum;
}

std::optional<std::uint32_t> Receiver::ssrc() const {
  if (!active_) return std::nullopt;
  return active_->ssrc;
}

}  // namespace lidar::rtp
