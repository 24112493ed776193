// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/scream/model/sent_history.h"

#include <algorithm>
#include <utility>

namespace lidar::scream {
namespace {

using namespace std::chrono_literals;

/// The greatest number of packets per SSRC. More packets cannot be kept, because extended sequence
/// numbers are unique only within half of their range.
constexpr std::size_t kMaxPackets = 32000;
/// Settled packets are kept so that repeated reports are recognised, and late packets are
/// distinguished from lost packets. If there are more than kMaxSettled, only packets younger than
/// kKeepSettled are kept.
constexpr std::size_t kMaxSettled = 1024;
constexpr Duration kKeepSettled = 1s;
/// A packet may be sent after packets with higher numbers if the numbers differ by less than this.
constexpr std::int64_t kOvertaken = 64;
/// The numbers of an SSRC start again if they go back by kFarBehind or more, and then
/// kUnknownBehind unknown numbers or kKnownBehind known numbers follow in a row. A receiver takes a
/// smaller step back for reordering, and does not count the packets after it until their numbers
/// are new again.
constexpr std::int64_t kFarBehind = 3000;
constexpr int kUnknownBehind = 2;
constexpr int kKnownBehind = 64;
/// Reports about the earlier numbers may arrive for this time after a restart.
constexpr Duration kReportsOfBefore = 2s;
/// A packet is given up if a packet that was sent this much later is acknowledged.
constexpr Duration kTailWait = 1s;
/// The reordering window keeps its size for this time, and then shrinks by 1 / kReorderingDecay
/// each second.
constexpr Duration kReorderingMemory = 5s;
constexpr int kReorderingDecay = 8;
/// The greatest number of SSRCs. Each restart may bring a new SSRC, so the SSRC that has been
/// silent for longest is forgotten.
constexpr std::size_t kMostSources = 64;
/// The tolerance for times in reports, because arrival offsets are multiples of 1/1024 s.
constexpr Duration kTimeTolerance = 2ms;

}  // namespace

void SentHistory::OnSent(std::uint32_t ssrc, std::uint16_t seq, const SentRecord& record) {
  const bool is_new = sources_.find(ssrc) == sources_.end();
  if (is_new && sources_.size() >= kMostSources) ForgetSilentSource();
  Source& source = sources_[ssrc];
  if (!is_new && StartsAgain(&source, source.unwrapper.Peek(seq)))
    StartAgain(record.sent, seq, &source);
  Packet packet;
  packet.seq = source.unwrapper.Unwrap(seq);
  packet.record = record;
  if (is_new) source.highest_acked = packet.seq - 1;
  Insert(&source, packet);
}

/// Inserts a packet that was sent. A packet that is sent again counts once, because feedback cannot
/// distinguish the copies.
void SentHistory::Insert(Source* source, const Packet& packet) {
  auto& packets = source->packets;
  if (packets.empty() || packets.back().seq < packet.seq) {
    packets.push_back(packet);
  } else {
    const bool overtaken =
        packet.seq > source->highest_acked && packets.back().seq - packet.seq < kOvertaken;
    if (!overtaken || Find(source, packet.seq) != nullptr) return;
    packets.insert(packets.begin() + FirstFrom(packets, packet.seq), packet);
  }
  in_flight_ += packet.record.size;
  Trim(source);
}

/// Returns true if the numbers start again, as after the restart of a payloader.
bool SentHistory::StartsAgain(Source* source, std::int64_t seq) {
  if (source->packets.empty() || seq > source->packets.back().seq) {
    source->behind = 0;
    return false;
  }
  if (source->packets.back().seq - seq < kFarBehind) return false;
  const bool known = Find(source, seq) != nullptr;
  source->behind = seq == source->next_behind ? source->behind + 1 : 1;
  source->next_behind = seq + 1;
  return source->behind >= (known ? kKnownBehind : kUnknownBehind);
}

void SentHistory::StartAgain(Time now, std::uint16_t seq, Source* source) {
  Settle(source, source->packets.back().seq);
  *source = Source{};
  source->highest_acked = std::int64_t{seq} - 1;
  source->restarted = now;
}

bool SentHistory::OfBefore(Time now, const Source& source, const rtcp::SsrcReport& block) {
  return source.restarted && now - *source.restarted < kReportsOfBefore &&
         source.unwrapper.Peek(block.begin_seq) > source.packets.back().seq;
}

std::optional<Time> SentHistory::oldest_in_flight() const {
  std::optional<Time> oldest;
  for (const auto& [ssrc, source] : sources_) {
    const auto first = source.packets.begin() + FirstFrom(source.packets, source.highest_acked + 1);
    if (first != source.packets.end())
      oldest = std::min(oldest.value_or(first->record.sent), first->record.sent);
  }
  return oldest;
}

bool SentHistory::full() const {
  return std::any_of(sources_.begin(), sources_.end(), [](const auto& entry) {
    const Source& source = entry.second;
    return !source.packets.empty() && source.packets.back().seq - source.highest_acked >=
                                          static_cast<std::int64_t>(kMaxPackets);
  });
}

void SentHistory::ForgetSilentSource() {
  const auto silent = std::min_element(sources_.begin(), sources_.end(), [](auto& a, auto& b) {
    return a.second.packets.back().record.sent < b.second.packets.back().record.sent;
  });
  Settle(&silent->second, silent->second.packets.back().seq);
  sources_.erase(silent);
}

/// Returns how many packets precede `seq`. Numbers ascend with few gaps. The result is therefore
/// near the distance from the first number to `seq`, and never above this distance.
std::ptrdiff_t SentHistory::FirstFrom(const std::deque<Packet>& packets, std::int64_t seq) {
  if (packets.empty() || seq <= packets.front().seq) return 0;
  const auto distance = static_cast<std::ptrdiff_t>(
      std::min<std::int64_t>(packets.end() - packets.begin(), seq - packets.front().seq));
  const auto most = packets.begin() + distance;
  if (most == packets.end() ? packets.back().seq < seq : most->seq == seq) return distance;
  const auto first = std::lower_bound(packets.begin(), most, seq,
                                      [](const Packet& p, std::int64_t s) { return p.seq < s; });
  return first - packets.begin();
}

SentHistory::Packet* SentHistory::Find(Source* source, std::int64_t seq) {
  const auto it = source->packets.begin() + FirstFrom(source->packets, seq);
  return it != source->packets.end() && it->seq == seq ? &*it : nullptr;
}

/// Returns false if the report acknowledges packets that were never sent, or that arrived before
/// they were sent.
bool SentHistory::Plausible(Time now, Source* source, const rtcp::SsrcReport& block) const {
  const std::int64_t newest = source->packets.back().seq;
  const std::int64_t oldest = source->packets.front().seq;
  const std::int64_t begin = source->unwrapper.Peek(block.begin_seq);
  for (std::size_t i = 0; i < block.metrics.size(); ++i) {
    const rtcp::PacketMetric& metric = block.metrics[i];
    const std::int64_t seq = begin + static_cast<std::int64_t>(i);
    if (!metric.received || seq < oldest) continue;
    const Packet* packet = seq > newest ? nullptr : Find(source, seq);
    if (packet == nullptr) return false;
    const Duration age = now - packet->record.sent;
    if (metric.arrival_offset && *metric.arrival_offset > age + kTimeTolerance) return false;
  }
  return true;
}

FeedbackResult SentHistory::OnFeedback(Time now, const rtcp::CongestionFeedback& feedback,
                                       AckSummary* summary) {
  bool any_ours = false;
  std::vector<std::pair<Source*, const rtcp::SsrcReport*>> news;
  for (const rtcp::SsrcReport& block : feedback.blocks) {
    const auto it = sources_.find(block.ssrc);
    if (it == sources_.end() || it->second.packets.empty()) {
      ++foreign_blocks_;
      continue;
    }
    any_ours = true;
    if (OfBefore(now, it->second, block)) continue;
    if (!Plausible(now, &it->second, block)) return FeedbackResult::kImplausible;
    news.emplace_back(&it->second, &block);
  }
  if (!any_ours) return FeedbackResult::kNotOurs;
  summary->report = clock_.Unwrap(feedback.report_timestamp);
  for (const auto& [source, block] : news) Apply(now, *block, source, summary);
  // A report lists one SSRC after the other, but the link carried the packets in the order of
  // sending. The packets are sorted into this order.
  std::stable_sort(summary->acked.begin(), summary->acked.end(),
                   [](const AckedPacket& a, const AckedPacket& b) { return a.sent < b.sent; });
  if (!summary->acked.empty()) newest_acked_ = std::max(newest_acked_, summary->acked.back().sent);
  summary->rtt = RoundTrip(now, *summary);
  ExpireTails();
  DetectLoss(now, &summary->lost);
  const bool nothing = summary->acked.empty() && summary->lost.empty() && summary->late_ce.empty();
  return nothing ? FeedbackResult::kStale : FeedbackResult::kAccepted;
}

/// Returns the round trip of the newest packet that shows it. If the receiver reports how long it
/// held the acknowledgement, this time is subtracted. Packets from an outage do not count, because
/// their delay says nothing about the current delay.
std::optional<Duration> SentHistory::RoundTrip(Time now, const AckSummary& summary) const {
  for (auto packet = summary.acked.rbegin(); packet != summary.acked.rend(); ++packet) {
    if (packet->arrival)
      return std::max(Duration{0}, now - packet->sent - (summary.report - *packet->arrival));
    if (!packet->expired && !arrivals_known_) return now - packet->sent;
  }
  return std::nullopt;
}

void SentHistory::Apply(Time now, const rtcp::SsrcReport& block, Source* source,
                        AckSummary* summary) {
  const std::int64_t begin = source->unwrapper.Peek(block.begin_seq);
  std::int64_t highest = source->highest_acked;
  for (std::size_t i = 0; i < block.metrics.size(); ++i)
    if (block.metrics[i].received)
      highest = std::max(highest, begin + static_cast<std::int64_t>(i));
  for (std::size_t i = 0; i < block.metrics.size(); ++i) {
    const std::int64_t seq = begin + static_cast<std::int64_t>(i);
    Packet* packet = Find(source, seq);
    if (packet == nullptr) continue;
    if (block.metrics[i].received)
      Acknowledge(now, block.metrics[i], packet, summary);
    else if (seq < highest)
      MarkMissing(now, source, packet);
  }
  summary->bytes_newly_acked += Settle(source, highest);
}

void SentHistory::Acknowledge(Time now, const rtcp::PacketMetric& metric, Packet* packet,
                              AckSummary* summary) {
  const bool ce = metric.ecn == Ecn::kCe;
  if (packet->state == State::kAcked) {
    if (ce && !packet->ce) {
      summary->late_ce.push_back(packet->record.sent);
      packet->ce = true;
    }
    return;
  }
  AckedPacket acked;
  static_cast<SentRecord&>(acked) = packet->record;
  acked.arrived_ecn = metric.ecn;
  acked.expired = packet->state == State::kExpired;
  if (metric.arrival_offset && !acked.expired)
    acked.arrival = summary->report - *metric.arrival_offset;
  acked.was_lost = packet->state == State::kLost;
  if (packet->state == State::kMissing || acked.was_lost) {
    reordering_window_ =
        std::min(max_reordering_window_, std::max(reordering_window_, now - packet->missing_since));
    last_reordering_ = now;
  }
  arrivals_known_ = arrivals_known_ || metric.arrival_offset;
  packet->state = State::kAcked;
  packet->ce = ce;
  if (ce) summary->bytes_newly_acked_ce += packet->record.size;
  summary->acked.push_back(acked);
}

/// Removes the packets up to `seq` from the bytes in flight. Returns the size of these packets.
DataSize SentHistory::Settle(Source* source, std::int64_t seq) {
  DataSize bytes;
  if (seq <= source->highest_acked) return bytes;
  auto it = source->packets.begin() + FirstFrom(source->packets, source->highest_acked + 1);
  for (; it != source->packets.end() && it->seq <= seq; ++it) bytes += it->record.size;
  source->highest_acked = seq;
  in_flight_ -= bytes;
  return bytes;
}

void SentHistory::MarkMissing(Time now, Source* source, Packet* packet) {
  if (packet->state != State::kOutstanding) return;
  packet->state = State::kMissing;
  packet->missing_since = now;
  source->missing.push_back(packet->seq);
}

void SentHistory::DecayReorderingWindow(Time now) {
  if (now - last_reordering_ < kReorderingMemory) return;
  last_reordering_ = now - kReorderingMemory + 1s;
  reordering_window_ -= reordering_window_ / kReorderingDecay;
}

void SentHistory::DetectLoss(Time now, std::vector<SentRecord>* lost) {
  DecayReorderingWindow(now);
  for (auto& [ssrc, source] : sources_) {
    std::vector<std::int64_t> still_missing;
    for (const std::int64_t seq : source.missing) {
      Packet* packet = Find(&source, seq);
      if (packet == nullptr || packet->state != State::kMissing) continue;
      if (now - packet->missing_since < reordering_window_) {
        still_missing.push_back(seq);
        continue;
      }
      packet->state = State::kLost;
      lost->push_back(packet->record);
    }
    source.missing = std::move(still_missing);
  }
}

void SentHistory::Trim(Source* source) {
  const auto& packets = source->packets;
  const auto superfluous = [&] {
    return packets.size() > kMaxSettled && packets[kMaxSettled].seq <= source->highest_acked &&
           packets.back().record.sent - packets.front().record.sent > kKeepSettled;
  };
  const auto ambiguous = [&] {
    return packets.back().seq - packets.front().seq >= static_cast<std::int64_t>(kMaxPackets);
  };
  while (ambiguous() || superfluous()) {
    Settle(source, packets.front().seq);
    source->packets.pop_front();
  }
}

void SentHistory::Expire(Time before) {
  for (auto& [ssrc, source] : sources_) {
    for (Packet& packet : source.packets) {
      if (packet.record.sent >= before) break;
      if (packet.state == State::kOutstanding || packet.state == State::kMissing)
        packet.state = State::kExpired;
      Settle(&source, packet.seq);
    }
  }
}

/// Gives up the last packets of an SSRC that has become silent, because no later packet of this
/// SSRC will show that they were lost.
void SentHistory::ExpireTails() {
  for (auto& [ssrc, source] : sources_) {
    auto packet = source.packets.begin() + FirstFrom(source.packets, source.highest_acked + 1);
    for (; packet != source.packets.end(); ++packet) {
      if (packet->record.sent + kTailWait >= newest_acked_) break;
      packet->state = State::kExpired;
      Settle(&source, packet->seq);
    }
  }
}

}  // namespace lidar::scream
