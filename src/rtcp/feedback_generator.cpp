// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rtcp/feedback_generator.h"

#include <algorithm>

#include "src/rtcp/report_clock.h"

namespace lidar::rtcp {
namespace {

constexpr std::size_t kMaxSources = 64;
/// A sequence number that is farther than this from the newest one belongs to another run of
/// numbers.
constexpr int kMaxJump = 3000;
/// A source that has more unreported numbers than this starts anew. There are so many only if a
/// hostile sender makes its numbers jump, or if reports cannot be sent.
constexpr int kMaxBacklog = 8192;
constexpr std::int64_t kIpUdp = 28;
constexpr std::int64_t kReportWithoutBlocks = 12;
constexpr std::int64_t kBlockWithoutMetrics = 8;
constexpr Duration kRatePeriod = 100ms;

std::int64_t BlockSize(std::int64_t metrics) {
  return kBlockWithoutMetrics + 2 * (metrics + metrics % 2);
}

}  // namespace

FeedbackGenerator::FeedbackGenerator(const FeedbackConfig& config) : config_(config) {}

void FeedbackGenerator::Reset() { *this = FeedbackGenerator(config_); }

void FeedbackGenerator::Forget(std::uint32_t ssrc) {
  const auto found = sources_.find(ssrc);
  if (found == sources_.end()) return;
  unreported_ -= found->second.unreported;
  sources_.erase(found);
}

void FeedbackGenerator::OnPacket(Time at, const ReceivedPacket& packet) {
  const Time arrival = clock_.From(at);
  ++stats_.packets;
  stats_.received += packet.size;
  if (packet.ecn == Ecn::kCe) ++stats_.ce_packets;
  MeasureRate(arrival, packet.size);
  Source* source = Find(arrival, packet.ssrc, packet.seq);
  if (source == nullptr) return;
  const auto seq = Locate(source, packet.seq);
  if (!seq) {
    ++stats_.stale;
    return;
  }
  source->last_arrival = arrival;
  if (!Store(source, *seq, arrival, packet.ecn)) {
    ++stats_.duplicates;
    return;
  }
  ++source->unreported;
  ++unreported_;
  Schedule(arrival, packet);
}

FeedbackGenerator::Source* FeedbackGenerator::Find(Time arrival, std::uint32_t ssrc,
                                                   std::uint16_t seq) {
  const auto found = sources_.find(ssrc);
  if (found != sources_.end()) return &found->second;
  for (auto it = sources_.begin(); it != sources_.end();) {
    const bool silent = arrival - it->second.last_arrival > config_.ssrc_timeout;
    if (silent) unreported_ -= it->second.unreported;
    it = silent ? sources_.erase(it) : std::next(it);
  }
  if (sources_.size() >= kMaxSources) return nullptr;
  Source* source = &sources_[ssrc];
  Start(source, seq);
  return source;
}

void FeedbackGenerator::Start(Source* source, std::uint16_t seq) {
  unreported_ -= source->unreported;
  *source = Source{};
  const std::int64_t extended = source->unwrapper.Unwrap(seq);
  source->first = source->next_report = source->lowest_new = extended;
}

/// Returns the extended sequence number, or nothing if the packet is ignored. A far jump of the
/// numbers counts as a restart of the sender after a second packet has confirmed it.
std::optional<std::int64_t> FeedbackGenerator::Locate(Source* source, std::uint16_t seq) {
  const std::int64_t extended = source->unwrapper.Peek(seq);
  const std::int64_t newest = source->unwrapper.newest().value_or(extended);
  if (extended > newest + kMaxJump || extended < newest - kMaxJump) {
    const bool confirmed = source->restart == seq;
    source->restart = static_cast<std::uint16_t>(seq + 1);
    if (!confirmed) return std::nullopt;
    Start(source, seq);
    return source->first;
  }
  source->restart.reset();
  // A packet before the first one extends the record backwards, but only until the first report.
  // After that, the record may have dropped this packet already.
  if (extended < source->first && source->next_report > source->first) return std::nullopt;
  if (extended - source->next_report > kMaxBacklog) {
    Start(source, seq);
    return source->first;
  }
  return source->unwrapper.Unwrap(seq);
}

/// Stores an arrival. Returns false if the packet has already arrived before.
bool FeedbackGenerator::Store(Source* source, std::int64_t seq, Time arrival, Ecn ecn) {
  while (seq < source->first) {
    source->window.emplace_front();
    --source->first;
    ++stats_.lost;  // until it is stored
    source->next_report = source->first;
  }
  if (seq >= source->end()) {
    stats_.lost += static_cast<std::uint64_t>(seq - source->end());
    source->window.resize(static_cast<std::size_t>(seq - source->first) + 1);
  } else if (!source->window[static_cast<std::size_t>(seq - source->first)].received) {
    ++stats_.reordered;
    if (stats_.lost > 0) --stats_.lost;
  }
  Arrival& a = source->window[static_cast<std::size_t>(seq - source->first)];
  if (a.received) {
    // RFC 8888 requires the time of the first copy, but the CE mark of any copy.
    if (ecn == Ecn::kCe) a.ecn = Ecn::kCe;
    return false;
  }
  a = {true, ecn, arrival};
  if (source->unreported == 0 || seq < source->lowest_new) source->lowest_new = seq;
  return true;
}

void FeedbackGenerator::MeasureRate(Time arrival, DataSize size) {
  if (!rate_since_) rate_since_ = arrival;
  const Duration elapsed = arrival - *rate_since_;
  if (elapsed >= kRatePeriod) {
    rate_ = rate_bytes_ / elapsed;
    rate_bytes_ = DataSize();
    rate_since_ = arrival;
  }
  rate_bytes_ += size;
}

Duration FeedbackGenerator::Interval() const {
  const DataSize report = DataSize::Bytes(
      kIpUdp + kReportWithoutBlocks + BlockSize(config_.overlap + config_.packets_per_feedback));
  const Duration affordable = report / (rate_ * config_.feedback_fraction);
  return std::min(config_.feedback_interval, std::max(config_.min_feedback_interval, affordable));
}

void FeedbackGenerator::Schedule(Time arrival, const ReceivedPacket& packet) {
  const bool ce = packet.ecn == Ecn::kCe;
  const bool changed = last_was_ce_.value_or(false) != ce;
  last_was_ce_ = ce;
  if ((config_.report_on_marker && packet.marker) || unreported_ >= config_.packets_per_feedback ||
      !last_report_) {
    due_ = std::min(due_, arrival);
  } else if (config_.report_on_ce_change && changed) {
    due_ = std::min(due_, std::max(arrival, *last_report_ + config_.ce_change_interval));
  } else {
    due_ = std::min(due_, std::max(arrival, *last_report_ + Interval()));
  }
}

/// Returns the greatest size that the next RTCP packet may have [bytes]. It keeps the sum of all
/// reports below the received bytes.
std::int64_t FeedbackGenerator::Allowance() const {
  return std::min(config_.max_report.bytes(), (stats_.received - stats_.sent).bytes() - kIpUdp);
}

std::optional<CongestionFeedback> FeedbackGenerator::Take(Time at) {
  const Time now = clock_.From(at);
  if (due_ > now) return std::nullopt;
  due_ = Time::max();
  CongestionFeedback report;
  report.sender_ssrc = config_.sender_ssrc;
  report.report_timestamp = ReportClock::ToTimestamp(now);
  std::int64_t size = kReportWithoutBlocks;
  const std::int64_t allowance = Allowance();
  for (auto& [ssrc, source] : sources_)
    size += AppendBlock(now, ssrc, &source, allowance - size, &report);
  if (report.blocks.empty()) return std::nullopt;  // the next packet makes it due again
  ++stats_.reports;
  stats_.sent += DataSize::Bytes(size + kIpUdp);
  last_report_ = now;
  if (unreported_ > 0) due_ = now;
  return report;
}

/// Returns the sequence number with which a block of `max_metrics` packets begins. The block
/// repeats some packets that were already reported (the overlap), if new and late packets leave
/// room.
std::int64_t FeedbackGenerator::FirstToReport(const Source& source,
                                              std::int64_t max_metrics) const {
  const std::int64_t fresh = std::min(source.next_report, source.lowest_new);
  const std::int64_t wanted = std::min(source.next_report - config_.overlap, fresh);
  return std::max({source.first, wanted, std::min(fresh, source.end() - max_metrics)});
}

/// Appends a block about `source` that fits into `room` bytes. Returns the number of bytes added.
std::int64_t FeedbackGenerator::AppendBlock(Time now, std::uint32_t ssrc, Source* source,
                                            std::int64_t room, CongestionFeedback* report) {
  const std::int64_t max_metrics = (room - kBlockWithoutMetrics) / 4 * 2;
  if (source->unreported == 0 || max_metrics < 1) return 0;
  SsrcReport block;
  const std::int64_t begin = FirstToReport(*source, max_metrics);
  const std::int64_t end = std::min(source->end(), begin + max_metrics);
  block.ssrc = ssrc;
  block.begin_seq = static_cast<std::uint16_t>(begin);
  for (std::int64_t seq = begin; seq < end; ++seq) {
    const Arrival& a = source->window[static_cast<std::size_t>(seq - source->first)];
    PacketMetric m{a.received, a.ecn, std::nullopt};
    if (a.received) m.arrival_offset = std::max(Duration{0}, now - a.time);
    block.metrics.push_back(m);
  }
  report->blocks.push_back(std::move(block));
  const bool complete = end == source->end();
  unreported_ -= source->unreported;
  source->next_report = source->lowest_new = end;
  source->unreported = complete ? 0 : static_cast<int>(source->end() - end);
  unreported_ += source->unreported;
  Trim(source);
  return BlockSize(end - begin);
}

void FeedbackGenerator::Trim(Source* source) const {
  const std::int64_t keep_from = source->next_report - std::max(config_.overlap, 512);
  while (source->first < keep_from && source->window.size() > 1) {
    source->window.pop_front();
    ++source->first;
  }
}

}  // namespace lidar::rtcp
