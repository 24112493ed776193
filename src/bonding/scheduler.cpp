// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/bonding/scheduler.h"

#include <algorithm>

namespace lidar::bonding {
namespace {

using namespace std::chrono_literals;

/// The round trip that is assumed until one is measured.
constexpr Duration kUnknownRtt = 100ms;
/// A link is in a gap if a report takes longer than a round trip plus this time, which allows for
/// slow machines.
constexpr Duration kReportMargin = 20ms;
/// The least advantage for which a slice goes to another link than the slice before it.
constexpr Duration kWorthLeaving = 5ms;
/// A link has room for copies if its FIFO empties within this time.
constexpr Duration kRoomForCopies = 25ms;
/// The encoder's target ignores a link whose reports are overdue by more than this.
constexpr Duration kLongestGap = 100ms;
/// Round trips count as equal if they differ by no more than this.
constexpr Duration kSimilarRtts = 50ms;
/// The rate of a link that is assumed until one is known.
constexpr DataRate kUnknownRate = DataRate::BitsPerSecond(1e6);
/// The time for which packets are remembered, because their acknowledgements may be late.
constexpr Duration kReceiptMemory = 2s;

}  // namespace

Scheduler::Scheduler(std::size_t links, Method method, TargetRule rule)
    : method_(method), rule_(rule), links_(std::clamp<std::size_t>(links, 1, kMaxLinks)) {}

void Scheduler::Restart() {
  Scheduler fresh(links_.size(), method_, rule_);
  for (std::size_t i = 0; i < links_.size(); ++i) fresh.links_[i].usable = links_[i].usable;
  *this = std::move(fresh);
}

Scheduler::Entry* Scheduler::Find(PacketId id) {
  const auto found = packets_.find(id.key());
  return found == packets_.end() ? nullptr : &found->second;
}

const Scheduler::Entry* Scheduler::Find(PacketId id) const {
  const auto found = packets_.find(id.key());
  return found == packets_.end() ? nullptr : &found->second;
}

Duration Scheduler::Rtt(const Link& link) {
  return link.path.rtt > Duration{0} ? link.path.rtt : kUnknownRtt;
}

/// Returns the least one-way time on the link, but at most half of kMaxAge. Because of this limit,
/// even a link with a long delay gets packets that are up to half of kMaxAge old.
Duration Scheduler::LeastTravel(const Link& link) {
  return std::min(link.path.min_rtt / 2, kMaxAge / 2);
}

/// Returns the time until the link has delivered `size` in addition to its queue. If the link is in
/// a gap, the gap is expected to last as long again as it has lasted so far.
Duration Scheduler::WholeIn(std::size_t link, Time now, DataSize size) const {
  const Link& l = links_[link];
  if (!l.usable) return Duration::max() / 2;
  const DataRate rate = l.path.rate > DataRate{} ? l.path.rate : kUnknownRate;
  const auto since = l.ledger.waiting_since();
  const Duration gap = InGap(now, link) && since ? now - *since : Duration{0};
  return std::min((l.queued + size) / rate, Duration{10s}) + Rtt(l) / 2 + gap;
}

std::size_t Scheduler::Best(Time now, DataSize size, LinkSet among) const {
  LinkSet known;
  for (std::size_t i = 0; i < links_.size(); ++i)
    if (links_[i].usable && links_[i].has_reported) known.set(i);
  if ((among & known).any()) among &= known;
  std::size_t best = kMaxLinks;
  Duration least{};
  for (std::size_t i = 0; i < links_.size(); ++i) {
    if (!among[i]) continue;
    Duration whole = WholeIn(i, now, size);
    if (i != slice_first_) whole += kWorthLeaving;
    if (best != kMaxLinks && whole >= least) continue;
    best = i;
    least = whole;
  }
  return best;
}

bool Scheduler::InGap(Time now, std::size_t link) const {
  const Link& l = links_[link];
  const auto since = l.ledger.waiting_since();
  return !l.usable || (since && now - *since > Rtt(l) + kReportMargin);
}

/// Returns the links that share a queue with a working link whose round trip is shorter. The round
/// trip of the last slice's link counts as shorter by kSimilarRtts.
LinkSet Scheduler::Spare(Time now) const {
  const auto far = [this](std::size_t link) {
    return std::pair(Rtt(links_[link]) - (link == slice_first_ ? kSimilarRtts : Duration{0}), link);
  };
  LinkSet spare;
  for (std::size_t i = 0; i < links_.size(); ++i)
    for (std::size_t k = 0; k < links_.size(); ++k)
      if (shared_.Shared(i, k) && !IsDead(now, links_[k]) && far(k) < far(i)) spare.set(i);
  return spare;
}

std::size_t Scheduler::Bottleneck(std::size_t link) const {
  for (std::size_t other = 0; other < link; ++other)
    if (shared_.Shared(link, other)) return Bottleneck(other);
  return link;
}

bool Scheduler::Settled(Time now) const {
  return std::all_of(links_.begin(), links_.end(), [now](const Link& l) {
    return l.unsettled_since && now - *l.unsettled_since > kUnsettled;
  });
}

bool Scheduler::Proves(Time now, const Link& link) {
  return !link.has_reported && now - link.usable_since.value_or(now) < kProving;
}

bool Scheduler::AwaitsArrivals(Time now) const {
  return std::any_of(order_.rbegin(), order_.rend(), [&](PacketId id) {
    const Entry* entry = Find(id);
    return !entry->arrived && now - entry->made <= kMaxAge;
  });
}

/// Returns the links that get a copy of the next slice, in addition to the best link.
LinkSet Scheduler::CopiesOf(Time now, DataSize slice) const {
  LinkSet links;
  const bool probe = slices_ % kProbeEvery == 0;
  const bool all = method_ == Method::kAdaptive && rule_ == TargetRule::kBetter && !Settled(now);
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const Link& l = links_[i];
    if (!l.usable || (spare_[i] && method_ != Method::kBroadcast)) continue;
    const DataRate rate = l.path.rate > DataRate{} ? l.path.rate : kUnknownRate;
    const bool room = (l.queued + slice) / rate < kRoomForCopies && !InGap(now, i);
    if (method_ == Method::kBroadcast || probe || Proves(now, l) || (all && room)) links.set(i);
  }
  return links;
}

void Scheduler::Assign(std::size_t link, Entry* entry) {
  entry->assigned.set(link);
  entry->waits.set(link);
  links_[link].queued += entry->size;
}

LinkSet Scheduler::OnPacket(Time now, const Packet& packet) {
  Forget(now);
  LookAtGaps(now);
  if (slice_ != packet.slice) {
    slice_ = packet.slice;
    last_slice_size_ = std::max(slice_size_, packet.size);
    slice_size_ = {};
    spare_ = Spare(now);
    slice_first_ = Best(now, last_slice_size_, ~spare_);
    slice_links_ = CopiesOf(now, last_slice_size_);
    slice_links_.set(slice_first_);
    ++slices_;
  }
  slice_size_ += packet.size;
  LinkSet to = slice_links_;
  if (packet.ends_slice && slices_ % kProbeSpareEvery == 0) to |= spare_;
  if (packets_.count(packet.id.key()) > 0) return to;  // the payloader sent it again
  Entry entry;
  entry.size = packet.size;
  entry.ends_slice = packet.ends_slice;
  entry.made = now;
  entry.first = slice_first_;
  entry.expected = now + WholeIn(slice_first_, now, last_slice_size_) +
                   Rtt(links_[slice_first_]) / 2 + kReportMargin;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    if (!to[i]) continue;
    Assign(i, &entry);
    ++(i == slice_first_ ? links_[i].counters.packets : links_[i].counters.copies);
    if (!links_[i].unsettled_since) links_[i].unsettled_since = now;
    if (!links_[i].usable_since) links_[i].usable_since = now;
  }
  order_.push_back(packet.id);
  packets_.emplace(packet.id.key(), entry);
  return to;
}

void Scheduler::Forget(Time now) {
  while (!order_.empty()) {
    const PacketId oldest = order_.front();
    if (order_.size() < kMaxPackets && now - Find(oldest)->made < kReceiptMemory) return;
    Erase(oldest);
    order_.pop_front();
  }
}

void Scheduler::Abandon(std::uint32_t ssrc) {
  const auto of_source = [ssrc](PacketId id) { return id.ssrc == ssrc; };
  for (const PacketId id : order_)
    if (of_source(id)) Erase(id);
  order_.erase(std::remove_if(order_.begin(), order_.end(), of_source), order_.end());
}

/// Erases the packet from packets_. The caller removes it from order_.
void Scheduler::Erase(PacketId id) {
  const auto found = packets_.find(id.key());
  for (std::size_t i = 0; i < links_.size(); ++i)
    if (found->second.waits[i]) links_[i].queued -= found->second.size;
  packets_.erase(found);
}

void Scheduler::LookAtGaps(Time now) {
  for (std::size_t i = 0; i < links_.size(); ++i) {
    Link& link = links_[i];
    const bool gap = InGap(now, i);
    if (gap && !link.was_in_gap) ++link.counters.gaps;
    if (gap) link.unsettled_since = now;
    link.was_in_gap = gap;
  }
}

/// Returns true if the packet is missing or late, or is in flight only over links that are in a
/// gap.
bool Scheduler::Overdue(Time now, const Entry& entry) const {
  if (entry.missing || now > entry.expected) return true;
  for (std::size_t i = 0; i < links_.size(); ++i)
    if (entry.assigned[i] && !InGap(now, i)) return false;
  return true;
}

/// Returns the links to which an overdue packet is copied. This is the best link that is not in a
/// gap. If there is no such link, these are all other links, because any of them may be the first
/// to leave its gap.
LinkSet Scheduler::OthersFor(Time now, const Entry& entry) const {
  const LinkSet spare = Spare(now);
  LinkSet others, alive;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    if (entry.assigned[i] || !links_[i].usable || spare[i]) continue;
    others.set(i);
    if (!InGap(now, i)) alive.set(i);
  }
  return alive.any() ? LinkSet().set(Best(now, entry.size, alive)) : others;
}

std::vector<Scheduler::Copy> Scheduler::TakeCopies(Time now) {
  std::vector<Copy> copies;
  Forget(now);
  LookAtGaps(now);
  for (auto id = order_.rbegin(); id != order_.rend(); ++id) {
    Entry& entry = packets_[id->key()];
    if (now - entry.made > kMaxAge) break;
    if (entry.arrived || !Overdue(now, entry)) continue;
    const LinkSet to = OthersFor(now, entry);
    if (to.none()) continue;
    for (std::size_t i = 0; i < links_.size(); ++i) {
      if (!to[i]) continue;
      copies.push_back({*id, i});
      Assign(i, &entry);
      ++links_[i].counters.copies;
    }
    const std::size_t best = Best(now, entry.size, to);
    entry.missing = false;
    entry.expected = now + WholeIn(best, now, entry.size) + Rtt(links_[best]) / 2 + kReportMargin;
  }
  std::reverse(copies.begin(), copies.end());  // oldest first
  return copies;
}

bool Scheduler::Wants(Time now, std::size_t link, PacketId id) const {
  const Entry* entry = Find(id);
  if (entry == nullptr) return true;
  const bool is_only_one = entry->assigned == LinkSet().set(link);
  const Duration age = now - entry->made + LeastTravel(links_[link]);
  return !entry->arrived && (is_only_one || age <= kMaxAge);
}

std::uint16_t Scheduler::OnSent(Time now, std::size_t link, PacketId id) {
  Link& l = links_[link];
  Entry* entry = Find(id);
  if (entry != nullptr && entry->waits[link]) {
    entry->waits.reset(link);
    l.queued -= entry->size;
  }
  if (entry != nullptr) shared_.OnSent(now, link, entry->size);
  return l.ledger.OnSent(now, id, entry == nullptr || entry->ends_slice);
}

bool Scheduler::OnDropped(Time, std::size_t link, PacketId id) {
  Entry* entry = Find(id);
  if (entry == nullptr || !entry->waits[link]) return false;
  entry->waits.reset(link);
  links_[link].queued -= entry->size;
  if (entry->arrived) ++links_[link].counters.cancelled;
  return entry->arrived;
}

std::optional<rtcp::CongestionFeedback> Scheduler::OnFeedback(
    Time, std::size_t link, const rtcp::CongestionFeedback& feedback) {
  auto report = links_[link].ledger.OnFeedback(feedback);
  if (!report) return std::nullopt;
  links_[link].has_reported = true;
  for (const LinkLedger::Arrival& arrival : report->arrived) {
    if (arrival.age)
      shared_.OnArrival(link, {arrival.sent, feedback.report_timestamp, *arrival.age});
    Entry* entry = Find(arrival.id);
    if (entry == nullptr || entry->arrived) continue;
    entry->arrived = true;
    if (entry->first != link) ++links_[link].counters.saved;
  }
  for (const PacketId id : report->missing)
    if (Entry* entry = Find(id); entry != nullptr) entry->missing = true;
  return std::move(report->feedback);
}

std::optional<std::size_t> Scheduler::OwnerOf(const rtcp::CongestionFeedback& feedback) const {
  for (std::size_t i = 0; i < links_.size(); ++i)
    if (links_[i].ledger.HasSent(feedback)) return i;
  return std::nullopt;
}

void Scheduler::SetUsable(Time now, std::size_t link, bool usable) {
  Link& l = links_[link];
  if (usable && !l.usable) {
    l.unsettled_since = l.usable_since = now;
    l.has_reported = false;
  }
  if (usable != l.usable) shared_.Forget(link);
  l.usable = usable;
}

bool Scheduler::IsDead(Time now, const Link& link) {
  const auto since = link.ledger.waiting_since();
  return !link.usable || (since && now - *since > Rtt(link) + kLongestGap);
}

DataRate Scheduler::Target(Time now, const std::vector<DataRate>& targets) const {
  const bool any_works =
      std::any_of(links_.begin(), links_.end(), [now](const Link& l) { return !IsDead(now, l); });
  Duration nearest = Duration::max();
  for (const Link& l : links_)
    if (!any_works || !IsDead(now, l)) nearest = std::min(nearest, Rtt(l));
  const LinkSet spare = Spare(now);
  DataRate sum, best;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    if (spare[i] || (any_works && IsDead(now, links_[i]))) continue;
    sum = sum + targets[i];
    if (Rtt(links_[i]) - nearest <= kSimilarRtts) best = std::max(best, targets[i]);
  }
  return rule_ == TargetRule::kSum && any_works ? sum : best;
}

}  // namespace lidar::bonding
