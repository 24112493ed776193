// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rtp/reassembler.h"

#include <algorithm>
#include <utility>

#include "src/base/sequence.h"

namespace lidar::rtp {
namespace {

// Several configs are kept, because slices with an earlier config may arrive after a newer config.
constexpr std::size_t kMaxConfigs = 4;
constexpr Duration kTick{100'000};  // the duration of 9 ticks at 90 kHz

Duration FromTicks(std::uint16_t ticks) { return kTick * ticks / 9; }

}  // namespace

std::int64_t Reassembler::Extend(std::uint32_t scan_number) const {
  return newest_scan_ + SequenceDistance(scan_number, static_cast<std::uint32_t>(newest_scan_));
}

bool Reassembler::Continues(const std::vector<Unit>& units) const {
  if (!ledger_.started()) return true;
  return std::all_of(units.begin(), units.end(), [&](const Unit& u) {
    const std::int64_t ahead = Extend(u.slice.scan_number) - newest_scan_;
    return !IsSlice(u.unit) || (ahead >= -kMaxScanBack && ahead <= kMaxScanJump);
  });
}

void Reassembler::Push(const RtpPacket& packet, const std::vector<Unit>& units,
                       std::vector<ReceivedSlice>* out) {
  Expire(packet.arrival);
  for (const Unit& unit : units) {
    if (IsSlice(unit.unit)) {
      PushSlice(packet, unit, out);
    } else {
      PushConfig(packet, unit, out);
    }
  }
  Bound();
}

bool Reassembler::Admit(SlicePosition p, const RtpPacket& packet, const Unit& unit) {
  // The first packet of the slice may still arrive.
  if (!ledger_.started() && !StartsUnit(unit.type)) return true;
  const bool first = !ledger_.started();
  switch (ledger_.Admit(p, unit.slice.count, packet.arrival)) {
    case Admission::kOpen:
      break;
    case Admission::kSettled:
      ++packets_.duplicate;
      return false;
    case Admission::kTooOld:
      ++packets_.late;
      return false;
    case Admission::kContradiction:
      ++packets_.invalid;
      return false;
  }
  if (first) DropBefore(p);
  return true;
}

void Reassembler::PushSlice(const RtpPacket& packet, const Unit& unit,
                            std::vector<ReceivedSlice>* out) {
  const SlicePosition p{Extend(unit.slice.scan_number), unit.slice.index};
  const bool was_started = ledger_.started();
  if (!Admit(p, packet, unit)) return;
  newest_scan_ = was_started ? std::max(newest_scan_, p.scan) : p.scan;
  for (KnownConfig& known : configs_) known.after_slices = false;
  const auto it = pending_.try_emplace(p).first;
  Pending& slice = it->second;
  if (!slice.bytes.empty()) {
    ++packets_.duplicate;
    return;
  }
  const std::size_t cost = slice.fragments.cost();
  const auto added = slice.fragments.Add(packet.sequence, unit);
  pending_bytes_ += slice.fragments.cost();
  pending_bytes_ -= cost;
  if (added == FragmentBuffer::Added::kDuplicate) ++packets_.duplicate;
  if (added == FragmentBuffer::Added::kContradiction) ++packets_.invalid;
  if (!slice.pts && packet.pts) slice.pts = *packet.pts + FromTicks(unit.timestamp_ticks);
  if (slice.fragments.IsWhole()) Complete(it, out);
}

void Reassembler::Complete(PendingMap::iterator it, std::vector<ReceivedSlice>* out) {
  Pending& slice = it->second;
  auto bytes = slice.fragments.Join();
  if (!bytes) {
    ledger_.Settle(it->first, SliceOutcome::kDamaged);
    Remove(it);
    return;
  }
  slice.bytes = *std::move(bytes);
  has_whole_slice_ = true;
  ledger_.BookScanId(it->first.scan, slice.fragments.start()->info.scan_id);
  BookSkipped(it->first, slice.fragments.start()->info.skipped);
  if (auto config = FindConfig(slice.fragments.start()->config_id))
    Emit(it, std::move(config), out);
}

/// Counts the slices as skipped that the sender skipped before `p`: bit n of `skipped` stands for
/// the slice that is n + 1 slices before `p`. A slice of which a packet has arrived does not count.
void Reassembler::BookSkipped(SlicePosition p, std::uint64_t skipped) {
  for (auto at = ledger_.Before(p); at && skipped != 0; at = ledger_.Before(*at), skipped >>= 1)
    if ((skipped & 1) != 0 && pending_.count(*at) == 0) ledger_.Skip(*at);
}

void Reassembler::Emit(PendingMap::iterator it, std::shared_ptr<const StreamConfig> config,
                       std::vector<ReceivedSlice>* out) {
  Pending& slice = it->second;
  const Unit& start = *slice.fragments.start();
  ReceivedSlice received;
  received.id = start.slice;
  received.info = start.info;
  received.pts = slice.pts;
  received.config = std::move(config);
  received.bytes = std::move(slice.bytes);
  received.discont = !missing_at_last_slice_ || Missing() > *missing_at_last_slice_;
  missing_at_last_slice_ = Missing();
  out->push_back(std::move(received));
  ledger_.Settle(it->first, SliceOutcome::kReceived);
  Remove(it);
}

void Reassembler::PushConfig(const RtpPacket& packet, const Unit& unit,
                             std::vector<ReceivedSlice>* out) {
  // Each repetition of the config starts a new buffer, because fragments of two repetitions must
  // not be mixed.
  const auto start = config_fragments_.start_sequence();
  if (StartsUnit(unit.type) && start && *start != packet.sequence) config_fragments_ = {};
  config_fragments_.Add(packet.sequence, unit);
  if (config_fragments_.cost() > kMaxUnitBytes) config_fragments_ = {};
  if (!config_fragments_.IsWhole()) return;
  const std::uint8_t id = config_fragments_.start()->config_id;
  const auto bytes = config_fragments_.Join();
  config_fragments_ = {};
  auto config = bytes ? StreamConfig::Parse({bytes->data(), bytes->size()}) : std::nullopt;
  if (!config) {
    ++packets_.config_damaged;
    return;
  }
  ++config_count_;
  KnownConfig* known = FindKnown(id);
  if (known != nullptr && *known->config == *config) {
    known->after_slices = true;
    return;
  }
  Learn(id, std::make_shared<const StreamConfig>(*std::move(config)), out);
}

void Reassembler::Learn(std::uint8_t id, std::shared_ptr<const StreamConfig> config,
                        std::vector<ReceivedSlice>* out) {
  const auto same =
      std::find_if(configs_.begin(), configs_.end(), [&](const auto& k) { return k.id == id; });
  if (same != configs_.end()) configs_.erase(same);
  configs_.push_front({id, config});
  if (configs_.size() > kMaxConfigs) configs_.pop_back();
  for (auto it = pending_.begin(); it != pending_.end();) {
    const auto next = std::next(it);
    if (!it->second.bytes.empty() && it->second.fragments.start()->config_id == id)
      Emit(it, config, out);
    it = next;
  }
}

bool Reassembler::IsAfter(const Reassembler& previous, std::int64_t max_scans) const {
  if (!ledger_.started() || !previous.ledger_.started()) return false;
  const SlicePosition end = *previous.ledger_.frontier();
  return end < ledger_.origin() && ledger_.origin().scan - end.scan <= max_scans;
}

void Reassembler::GoOn(const Reassembler& previous, std::vector<ReceivedSlice>* out) {
  ledger_.Continue(previous.ledger_);
  TakeConfigs(previous, true, out);
}

void Reassembler::StartAnew(const Reassembler& previous, std::vector<ReceivedSlice>* out) {
  TakeConfigs(previous, false, out);
}

void Reassembler::JoinAnew(Time now) {
  ledger_.StartAnew();
  missing_at_last_slice_.reset();
  for (auto it = pending_.begin(); it != pending_.end();) {
    const Unit* start = it->second.fragments.start();
    if (start != nullptr) ledger_.Admit(it->first, start->slice.count, now);
    it = start != nullptr ? std::next(it) : Remove(it);
  }
}

void Reassembler::TakeConfigs(const Reassembler& previous, bool all,
                              std::vector<ReceivedSlice>* out) {
  for (auto known = previous.configs_.rbegin(); known != previous.configs_.rend(); ++known)
    if ((all || known->after_slices) && !FindConfig(known->id))
      Learn(known->id, known->config, out);
}

void Reassembler::Expire(Time now) {
  const auto limit = ledger_.Overdue(now);
  if (!limit) return;
  DropBefore(*limit);
  ledger_.CloseBefore(*limit);
}

void Reassembler::DropBefore(SlicePosition limit) {
  for (auto it = pending_.begin(); it != pending_.end() && it->first < limit;) it = Remove(it);
}

Reassembler::PendingMap::iterator Reassembler::Remove(PendingMap::iterator it) {
  // If a whole slice is removed before it was output, its config has never arrived.
  if (!it->second.bytes.empty()) ledger_.Settle(it->first, SliceOutcome::kConfigMismatch);
  pending_bytes_ -= it->second.fragments.cost();
  return pending_.erase(it);
}

void Reassembler::Bound() {
  while (pending_.size() > kMaxPendingSlices || pending_bytes_ > kMaxPendingBytes) {
    const SlicePosition oldest = pending_.begin()->first;
    Remove(pending_.begin());
    if (ledger_.started()) ledger_.Settle(oldest, SliceOutcome::kLost);
  }
}

void Reassembler::Finish() {
  while (!pending_.empty()) Remove(pending_.begin());
  ledger_.Finish();
}

Reassembler::KnownConfig* Reassembler::FindKnown(std::uint8_t id) {
  for (KnownConfig& known : configs_)
    if (known.id == id) return &known;
  return nullptr;
}

std::shared_ptr<const StreamConfig> Reassembler::FindConfig(std::uint8_t id) const {
  for (const KnownConfig& k : configs_)
    if (k.id == id) return k.config;
  return nullptr;
}

std::uint64_t Reassembler::Missing() const {
  const SliceAccounts& a = ledger_.accounts();
  return a.slices_lost + a.slices_damaged + a.slices_config_mismatch;
}

}  // namespace lidar::rtp
