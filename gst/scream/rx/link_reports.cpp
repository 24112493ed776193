// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/rx/link_reports.h"

#include <algorithm>

#include "src/base/sequence.h"

namespace lidar::gst {
namespace {

void AddFeedback(const rtcp::FeedbackGenerator::Stats& s, rtcp::FeedbackGenerator::Stats* sum) {
  sum->packets += s.packets;
  sum->ce_packets += s.ce_packets;
  sum->duplicates += s.duplicates;
  sum->reordered += s.reordered;
  sum->stale += s.stale;
  sum->lost += s.lost;
  sum->reports += s.reports;
  sum->received += s.received;
  sum->sent += s.sent;
}

}  // namespace

void LinkReports::Reset(const rtcp::FeedbackConfig& config) {
  config_ = config;
  links_.clear();
  replaced_ = {};
}

void LinkReports::set_config(const rtcp::FeedbackConfig& config) {
  config_ = config;
  for (Link& link : links_) link.generator.set_config(config);
}

LinkReports::Link& LinkReports::LinkOf(GSocketAddress* from) {
  for (Link& link : links_) {
    if (from != nullptr && link.address && !SameAddress(from, link.address.get())) continue;
    // Keeps the packet's address object, because SameAddress() is fast if the next packet has the
    // same object.
    if (from != nullptr && from != link.address.get())
      link.address.reset(G_SOCKET_ADDRESS(g_object_ref(from)));
    return link;
  }
  if (links_.size() >= kMaxLinks) {
    const auto oldest = std::min_element(
        links_.begin(), links_.end(), [](const Link& a, const Link& b) { return a.last < b.last; });
    AddFeedback(oldest->generator.stats(), &replaced_);
    links_.erase(oldest);
  }
  Link link;
  if (from != nullptr) link.address.reset(G_SOCKET_ADDRESS(g_object_ref(from)));
  link.generator = rtcp::FeedbackGenerator(config_);
  links_.push_back(std::move(link));
  return links_.back();
}

void LinkReports::OnPacket(GSocketAddress* from, Time arrival, const rtcp::ReceivedPacket& packet) {
  Link& link = LinkOf(from);
  link.last = arrival;
  link.generator.OnPacket(arrival, packet);
}

void LinkReports::Forget(std::uint32_t ssrc) {
  for (Link& link : links_) link.generator.Forget(ssrc);
}

Time LinkReports::NextDue() const {
  Time due = Time::max();
  for (const Link& link : links_) due = std::min(due, link.generator.NextDue());
  return due;
}

std::optional<LinkReports::Report> LinkReports::Take(Time now) {
  for (Link& link : links_)
    if (auto feedback = link.generator.Take(now))
      return Report{std::move(*feedback), link.address.get()};
  return std::nullopt;
}

std::vector<LinkReports::LinkStats> LinkReports::stats() const {
  std::vector<LinkStats> stats;
  for (const Link& link : links_)
    stats.push_back({AddressToString(link.address.get()), link.generator.stats()});
  return stats;
}

rtcp::FeedbackGenerator::Stats LinkReports::Sum() const {
  rtcp::FeedbackGenerator::Stats sum = replaced_;
  for (const Link& link : links_) AddFeedback(link.generator.stats(), &sum);
  return sum;
}

bool SeenPackets::ShowsRestart(std::uint32_t ssrc, std::uint16_t seq,
                               std::uint32_t timestamp) const {
  const auto found = sources_.find(ssrc);
  if (found == sources_.end()) return false;
  const Source& source = found->second;
  const int ahead = SequenceDistance(seq, source.newest);
  return ahead <= 0 && ahead > -kWindow && source.seen[seq % kWindow] &&
         source.timestamps[seq % kWindow] != timestamp;
}

bool SeenPackets::Add(std::uint32_t ssrc, std::uint16_t seq, std::uint32_t timestamp) {
  if (sources_.count(ssrc) == 0) {
    if (sources_.size() >= kMaxSources) sources_.erase(sources_.begin());
    sources_[ssrc].newest = seq;
  }
  Source& source = sources_[ssrc];
  if (ShowsRestart(ssrc, seq, timestamp)) {
    source.seen.reset();
    source.newest = seq;
  }
  const int ahead = SequenceDistance(seq, source.newest);
  if (ahead <= -kWindow) return true;
  for (int i = 1; i <= std::min(ahead, kWindow); ++i)
    source.seen.reset(static_cast<std::uint16_t>(source.newest + i) % kWindow);
  if (ahead > 0) source.newest = seq;
  if (source.seen[seq % kWindow]) return false;
  source.seen.set(seq % kWindow);
  source.timestamps[seq % kWindow] = timestamp;
  return true;
}

}  // namespace lidar::gst
