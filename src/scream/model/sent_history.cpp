// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/scream/model/sent_history.h"

#include <algorithm>

namespace lidar::scream {
namespace {

using namespace std::chrono_literals;

/// Per SSRC; a quarter of the sequence numbers, so that extension stays exact.
constexpr std::size_t kMaxPackets = 16384;
/// Settled packets kept, so that repeated reports find them.
constexpr std::size_t kMaxSettled = 1024;
/// SSRCs come and go with restarts; the one silent for longest is forgotten.
constexpr std::size_t kMaxSources = 64;
/// The report's fields are coarse: arrival offsets of 1/1024 s.
constexpr Duration kTimeTolerance = 2ms;

}  // namespace

void SentHistory::OnSent(std::uint32_t ssrc, std::uint16_t seq, const SentRecord& record) {
  const bool is_new = sources_.find(ssrc) == sources_.end();
  if (is_new && sources_.size() >= kMaxSources) ForgetSilentSource();
  Source& source = sources_[ssrc];
  Packet packet;
  packet.seq = source.unwrapper.Unwrap(seq);
  packet.record = record;
  if (is_new) source.highest_acked = packet.seq - 1;
  if (source.packets.empty() || source.packets.back().seq < packet.seq) {
    source.packets.push_back(packet);
    in_flight_ += record.size;
    Trim(&source, &in_flight_);
  }
  // A number sent before (a repeated packet) is accounted once: feedback cannot tell the copies.
}

void SentHistory::ForgetSilentSource() {
  const auto silent = std::min_element(sources_.begin(), sources_.end(), [](auto& a, auto& b) {
    return a.second.packets.back().record.sent < b.second.packets.back().record.sent;
  });
  for (const Packet& packet : silent->second.packets)
    if (packet.seq > silent->second.highest_acked) in_flight_ -= packet.record.size;
  sources_.erase(silent);
}

SentHistory::Packet* SentHistory::Find(Source* source, std::int64_t seq) {
  auto it = std::lower_bound(source->packets.begin(), source->packets.end(), seq,
                             [](const Packet& p, std::int64_t s) { return p.seq < s; });
  return it != source->packets.end() && it->seq == seq ? &*it : nullptr;
}

/// Nothing received that was never sent, and nothing that came back before it went.
bool SentHistory::Plausible(Time now, Source* source, const SsrcReport& block) const {
  const std::int64_t newest = source->packets.back().seq;
  const std::int64_t oldest = source->packets.front().seq;
  const std::int64_t begin = source->unwrapper.Peek(block.begin_seq);
  for (std::size_t i = 0; i < block.metrics.size(); ++i) {
    const PacketMetric& metric = block.metrics[i];
    const std::int64_t seq = begin + static_cast<std::int64_t>(i);
    if (!metric.received || seq < oldest) continue;
    const Packet* packet = seq > newest ? nullptr : Find(source, seq);
    if (packet == nullptr) return false;
    const Duration age = now - packet->record.sent;
    if (metric.arrival_offset && *metric.arrival_offset > age + kTimeTolerance) return false;
  }
  return true;
}

HistoryResult SentHistory::OnFeedback(Time now, const CongestionFeedback& feedback,
                                      AckSummary* summary) {
  bool any_ours = false;
  for (const SsrcReport& block : feedback.blocks) {
    const auto it = sources_.find(block.ssrc);
    if (it == sources_.end() || it->second.packets.empty()) {
      ++foreign_blocks_;
      continue;
    }
    any_ours = true;
    if (!Plausible(now, &it->second, block)) return HistoryResult::kImplausible;
  }
  if (!any_ours) return HistoryResult::kNotOurs;
  const Time report = clock_.Unwrap(feedback.report_timestamp);
  for (const SsrcReport& block : feedback.blocks) {
    const auto it = sources_.find(block.ssrc);
    if (it != sources_.end() && !it->second.packets.empty())
      Apply(now, block, &it->second, report, summary);
  }
  DetectLoss(now, &summary->lost);
  const bool nothing = summary->acked.empty() && summary->lost.empty() && summary->late_ce == 0;
  return nothing ? HistoryResult::kNothingNew : HistoryResult::kApplied;
}

void SentHistory::Apply(Time now, const SsrcReport& block, Source* source, Time report,
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
      Acknowledge(now, block.metrics[i], report, block.ssrc, packet, summary);
    else if (seq < highest)
      MarkMissing(now, source, packet);
  }
  AdvanceHighest(source, highest, summary);
}

void SentHistory::Acknowledge(Time now, const PacketMetric& metric, Time report, std::uint32_t ssrc,
                              Packet* packet, AckSummary* summary) {
  const bool ce = metric.ecn == Ecn::kCe;
  if (packet->state == State::kAcked) {
    if (ce && !packet->ce) {
      ++summary->late_ce;
      packet->ce = true;
    }
    return;
  }
  AckedPacket acked;
  static_cast<SentRecord&>(acked) = packet->record;
  acked.ssrc = ssrc;
  acked.arrived_ecn = metric.ecn;
  // What the path held back through an outage says nothing about its delay now.
  const bool timed = metric.arrival_offset && packet->state != State::kExpired;
  if (timed) acked.arrival = report - *metric.arrival_offset;
  acked.was_lost = packet->state == State::kLost;
  if (packet->state == State::kMissing || acked.was_lost)
    reordering_window_ =
        std::min(max_reordering_window_, std::max(reordering_window_, now - packet->missing_since));
  packet->state = State::kAcked;
  packet->ce = ce;
  if (ce) summary->bytes_newly_acked_ce += packet->record.size;
  if (timed) {
    const bool last = summary->acked.empty() || packet->record.sent >= summary->acked.back().sent;
    if (last || !summary->rtt)
      summary->rtt = std::max(Duration{0}, now - packet->record.sent - *metric.arrival_offset);
  }
  summary->acked.push_back(acked);
}

void SentHistory::AdvanceHighest(Source* source, std::int64_t seq, AckSummary* summary) {
  if (seq <= source->highest_acked) return;
  auto it = std::upper_bound(source->packets.begin(), source->packets.end(), source->highest_acked,
                             [](std::int64_t s, const Packet& p) { return s < p.seq; });
  for (; it != source->packets.end() && it->seq <= seq; ++it) {
    summary->bytes_newly_acked += it->record.size;
    in_flight_ -= it->record.size;
  }
  source->highest_acked = seq;
}

void SentHistory::MarkMissing(Time now, Source* source, Packet* packet) {
  if (packet->state != State::kOutstanding) return;
  packet->state = State::kMissing;
  packet->missing_since = now;
  source->missing.push_back(packet->seq);
}

void SentHistory::DetectLoss(Time now, std::vector<LostPacket>* lost) {
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
      LostPacket p;
      static_cast<SentRecord&>(p) = packet->record;
      p.ssrc = ssrc;
      lost->push_back(p);
    }
    source.missing = std::move(still_missing);
  }
}

void SentHistory::Trim(Source* source, DataSize* in_flight) {
  while (source->packets.size() > kMaxPackets ||
         (source->packets.size() > kMaxSettled &&
          source->packets[kMaxSettled].seq <= source->highest_acked)) {
    const Packet& front = source->packets.front();
    if (front.seq > source->highest_acked) {
      *in_flight -= front.record.size;
      source->highest_acked = front.seq;
    }
    source->packets.pop_front();
  }
}

void SentHistory::Expire(Time before) {
  for (auto& [ssrc, source] : sources_) {
    for (Packet& packet : source.packets) {
      if (packet.record.sent >= before) break;
      if (packet.state == State::kOutstanding || packet.state == State::kMissing)
        packet.state = State::kExpired;
      if (packet.seq <= source.highest_acked) continue;
      in_flight_ -= packet.record.size;
      source.highest_acked = packet.seq;
    }
  }
}

}  // namespace lidar::scream
