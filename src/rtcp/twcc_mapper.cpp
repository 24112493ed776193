// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rtcp/twcc_mapper.h"

#include <algorithm>
#include <map>

namespace lidar::rtcp {
namespace {

using Metrics = std::map<std::int64_t, PacketMetric>;

/// Appends a block for each run of consecutive sequence numbers. Packets between two runs were not
/// reported.
void AppendBlocks(std::uint32_t ssrc, const Metrics& metrics, CongestionFeedback* report) {
  std::int64_t next = 0;
  for (const auto& [seq, metric] : metrics) {
    const bool first = report->blocks.empty() || report->blocks.back().ssrc != ssrc;
    if (first || seq != next) report->blocks.push_back({ssrc, static_cast<std::uint16_t>(seq), {}});
    report->blocks.back().metrics.push_back(metric);
    next = seq + 1;
  }
}

}  // namespace

void TwccMapper::OnSent(std::uint16_t number, std::uint32_t ssrc, std::uint16_t seq) {
  const std::int64_t extended = numbers_.Peek(number);
  const std::int64_t end = first_ + static_cast<std::int64_t>(sent_.size());
  if (sent_.empty() || extended < first_ || extended > end + kMaxHistory) {
    // This is the first packet, or the numbers have started anew.
    sent_.clear();
    numbers_.Reset();
    first_ = numbers_.Unwrap(number);
    sent_.push_back({true, ssrc, seq});
    return;
  }
  numbers_.Unwrap(number);
  if (extended >= end) sent_.resize(static_cast<std::size_t>(extended - first_) + 1);
  sent_[static_cast<std::size_t>(extended - first_)] = {true, ssrc, seq};
  while (static_cast<std::int64_t>(sent_.size()) > kMaxHistory) {
    sent_.pop_front();
    ++first_;
  }
}

const TwccMapper::Sent* TwccMapper::Find(std::uint16_t number) const {
  const std::int64_t index = numbers_.Peek(number) - first_;
  if (index < 0 || index >= static_cast<std::int64_t>(sent_.size())) return nullptr;
  const Sent& sent = sent_[static_cast<std::size_t>(index)];
  return sent.ours ? &sent : nullptr;
}

/// Returns `arrival` plus the multiple of kTwccPeriod that brings it nearest to the newest arrival.
Duration TwccMapper::Unwrap(Duration arrival) {
  if (!newest_) return arrival;
  const std::int64_t away = (*newest_ - arrival).count();
  const std::int64_t half = kTwccPeriod.count() / 2;
  const std::int64_t periods = (away + (away < 0 ? -half : half)) / kTwccPeriod.count();
  return arrival + periods * kTwccPeriod;
}

std::optional<CongestionFeedback> TwccMapper::Map(const TwccFeedback& feedback) {
  std::optional<Duration> last;
  for (const auto& arrival : feedback.arrivals)
    if (arrival) last = std::max(last.value_or(*arrival), *arrival);
  CongestionFeedback report;
  std::map<std::uint32_t, Metrics> by_ssrc;
  std::map<std::uint32_t, SequenceUnwrapper<std::uint16_t>> unwrap;
  std::uint16_t number = feedback.base_number;
  for (const auto& arrival : feedback.arrivals) {
    const Sent* sent = Find(number++);
    if (sent == nullptr) continue;
    PacketMetric metric;
    metric.received = arrival.has_value();
    if (arrival) metric.arrival_offset = *last - *arrival;
    by_ssrc[sent->ssrc][unwrap[sent->ssrc].Unwrap(sent->seq)] = metric;
  }
  if (by_ssrc.empty()) return std::nullopt;
  for (const auto& [ssrc, metrics] : by_ssrc) AppendBlocks(ssrc, metrics, &report);
  const Duration time = last ? Unwrap(*last) : newest_.value_or(Duration{0});
  newest_ = std::max(newest_.value_or(time), time);
  report.report_timestamp = ReportClock::ToTimestamp(Time{time});
  return report;
}

}  // namespace lidar::rtcp
