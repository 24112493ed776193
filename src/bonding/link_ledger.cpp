// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/bonding/link_ledger.h"

#include <algorithm>

namespace lidar::bonding {

std::uint16_t LinkLedger::OnSent(Time now, PacketId id, bool ends_slice) {
  if (sources_.count(id.ssrc) == 0 && sources_.size() >= kMaxSources) ForgetSilentSource();
  Source& source = sources_[id.ssrc];
  const std::int64_t number = source.end();
  source.packets.push_back({id.seq, now, ends_slice});
  source.numbers[id.seq] = number;
  Trim(&source);
  return static_cast<std::uint16_t>(number);
}

void LinkLedger::ForgetSilentSource() {
  sources_.erase(std::min_element(sources_.begin(), sources_.end(), [](auto& a, auto& b) {
    return a.second.packets.back().sent < b.second.packets.back().sent;
  }));
}

void LinkLedger::Trim(Source* source) {
  if (source->packets.size() <= kMaxPackets) return;
  const auto named = source->numbers.find(source->packets.front().seq);
  if (named != source->numbers.end() && named->second == source->first)
    source->numbers.erase(named);
  source->packets.pop_front();
  ++source->first;
  source->waiting = std::max(source->waiting, source->first);
}

/// Converts the packets in `block` that have arrived to the numbers of this link. Returns false if
/// the block names packets that this link never sent.
bool LinkLedger::Translate(const Source& source, const rtcp::SsrcReport& block,
                           rtcp::SsrcReport* own) {
  std::vector<std::pair<std::int64_t, const rtcp::PacketMetric*>> arrived;
  for (std::size_t i = 0; i < block.metrics.size(); ++i) {
    if (!block.metrics[i].received) continue;
    const auto found = source.numbers.find(static_cast<std::uint16_t>(block.begin_seq + i));
    if (found == source.numbers.end()) return false;
    arrived.emplace_back(found->second, &block.metrics[i]);
  }
  own->ssrc = block.ssrc;
  if (arrived.empty()) return true;
  const auto [first, last] = std::minmax_element(arrived.begin(), arrived.end());
  own->begin_seq = static_cast<std::uint16_t>(first->first);
  own->metrics.resize(static_cast<std::size_t>(last->first - first->first) + 1);
  for (const auto& [number, metric] : arrived)
    own->metrics[static_cast<std::size_t>(number - first->first)] = *metric;
  return true;
}

void LinkLedger::Settle(const rtcp::SsrcReport& own, Source* source, Report* report) {
  if (own.metrics.empty()) return;
  // The numbers in the block lie within one cycle of 16 bits, because kMaxPackets is less than a
  // cycle.
  const std::int64_t begin =
      source->end() - static_cast<std::uint16_t>(source->end() - own.begin_seq);
  for (std::size_t i = 0; i < own.metrics.size(); ++i) {
    Packet& packet = source->At(begin + static_cast<std::int64_t>(i));
    if (!own.metrics[i].received || packet.settled) continue;
    packet.settled = true;
    report->arrived.push_back({{own.ssrc, packet.seq}, packet.sent, own.metrics[i].arrival_offset});
  }
  const std::int64_t end = begin + static_cast<std::int64_t>(own.metrics.size());
  for (; source->waiting < end; ++source->waiting) {
    Packet& packet = source->At(source->waiting);
    if (!packet.settled) report->missing.push_back({own.ssrc, packet.seq});
  }
}

std::optional<LinkLedger::Report> LinkLedger::OnFeedback(const rtcp::CongestionFeedback& feedback) {
  Report report;
  report.feedback = feedback;
  report.feedback.blocks.clear();
  for (const rtcp::SsrcReport& block : feedback.blocks) {
    const auto source = sources_.find(block.ssrc);
    rtcp::SsrcReport own;
    if (source == sources_.end()) {
      report.feedback.blocks.push_back(block);  // the controller counts unknown blocks
      continue;
    }
    if (!Translate(source->second, block, &own)) return std::nullopt;
    if (!own.metrics.empty()) report.feedback.blocks.push_back(std::move(own));
  }
  for (const rtcp::SsrcReport& own : report.feedback.blocks) {
    const auto source = sources_.find(own.ssrc);
    if (source != sources_.end()) Settle(own, &source->second, &report);
  }
  return report;
}

bool LinkLedger::HasSent(const rtcp::CongestionFeedback& feedback) const {
  return std::all_of(feedback.blocks.begin(), feedback.blocks.end(), [this](const auto& block) {
    const auto source = sources_.find(block.ssrc);
    rtcp::SsrcReport own;
    return source != sources_.end() && Translate(source->second, block, &own);
  });
}

Time LinkLedger::Source::ReportOf(std::size_t packet) const {
  const Time latest = packets[packet].sent + kReportEvery;
  for (std::size_t i = packet; i < packets.size() && packets[i].sent < latest; ++i)
    if (packets[i].ends_slice) return packets[i].sent;
  return latest;
}

std::optional<Time> LinkLedger::waiting_since() const {
  std::optional<Time> since;
  for (const auto& [ssrc, source] : sources_) {
    if (source.waiting >= source.end()) continue;
    const Time report = source.ReportOf(static_cast<std::size_t>(source.waiting - source.first));
    since = std::min(since.value_or(report), report);
  }
  return since;
}

}  // namespace lidar::bonding
