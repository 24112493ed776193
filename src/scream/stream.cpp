// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/scream/stream.h"

#include <algorithm>

namespace lidar::scream {
namespace {

constexpr double kMaxRateAdjustFactor = 0.5;
constexpr double kMaxFrameSizeDev = 0.2;
/// A rate_adjust_factor below this counts as no adjustment.
constexpr double kNoAdjustment = 0.05;
constexpr double kFramePeriodGain = 0.1;
/// A longer time between frames is a pause, and not a frame period.
constexpr Duration kMaxFramePeriod = 2s;
constexpr Duration kMinFramePeriod = 1ms;
constexpr Duration kLikelyFramePeriod = 200ms;
/// Distinguishes video from scans. The value is between the period of film, 42 ms, and the period
/// of scans at 20 Hz, 50 ms.
constexpr Duration kScanPeriod = 45ms;
/// If a part of a group has been sent, the rest may wait this many times max_queue_delay.
constexpr int kBegunStay = 5;
/// A stream that has no packets for this time leaves its share to other streams.
constexpr Duration kInactive = 1s;

}  // namespace

Stream::Stream(const Parameters& parameters, const StreamConfig& config)
    : p_(parameters), config_(config), target_bitrate_(config.start_bitrate) {}

bool Stream::OnQueued(Time now, const QueuedPacket& packet) {
  ssrcs_.insert(packet.ssrc);
  last_active_ = now;
  const bool is_media = !media_ssrc_ || *media_ssrc_ == packet.ssrc || packet.marker;
  const bool starts_frame = is_media && frame_timestamp_ != packet.rtp_timestamp;
  queue_.push_back({packet.size, now, starts_frame, is_media ? packet.group : std::nullopt});
  queued_ += packet.size;
  if (!is_media) return false;
  if (packet.group) NoteGroup(now, packet);
  media_ssrc_ = packet.ssrc;
  if (starts_frame) {
    frame_size_ = DataSize();
    frame_begin_ = now;
  }
  frame_timestamp_ = packet.rtp_timestamp;
  frame_size_ += packet.size;
  if (!packet.marker) return false;
  OnFrame(now);
  frame_timestamp_.reset();
  return true;
}

/// Draft section "Media Rate Control": updates rate_adjust_factor and frame_size_dev for each
/// frame.
void Stream::OnFrame(Time now) {
  if (last_frame_ && now - *last_frame_ < kMaxFramePeriod) {
    // The first interval sets the period, unless it may be a pause.
    const bool first = !frame_period_known_ && now - *last_frame_ <= kLikelyFramePeriod;
    const double gain = first ? 1 : kFramePeriodGain;
    const double seconds = Seconds(frame_period_) * (1 - gain) + Seconds(now - *last_frame_) * gain;
    frame_period_known_ = true;
    frame_period_ = std::max(kMinFramePeriod, FromSeconds(seconds));
  }
  last_frame_ = now;
  const double error = Seconds(media_qdelay(now) - frame_period_ / 4) / Seconds(frame_period_);
  rate_adjust_factor_ =
      std::clamp(rate_adjust_factor_ + error * p_.rate_adjust_gain, 0.0, kMaxRateAdjustFactor);
  // This does not apply to whole scans, because each of them is a backlog by itself.
  if (sudden_backlog_ && !sends_scans() && error < 0) {
    rate_adjust_factor_ /= 2;
    sudden_backlog_ = rate_adjust_factor_ > kNoAdjustment;
  }
  const DataSize nominal = target_bitrate_ * frame_period_;
  if (nominal.bytes() <= 0) return;
  const double deviation = std::max(0.0, (frame_size_ - nominal) / nominal);
  frame_size_dev_ = std::min(kMaxFrameSizeDev, (1 - p_.frame_size_dev_alpha) * frame_size_dev_ +
                                                   p_.frame_size_dev_alpha * deviation);
}

void Stream::OnSent(Time now, std::uint32_t ssrc, DataSize size) {
  ssrcs_.insert(ssrc);
  sent_rate_.Add(now, size);
  ++counters_.packets_sent;
  counters_.bytes_sent += size;
  if (!queue_.empty()) TakeHead(now);
}

void Stream::OnUnneeded(Time now) {
  ++counters_.packets_dropped;
  if (!queue_.empty()) TakeHead(now);
}

void Stream::TakeHead(Time now) {
  if (queue_.front().group) begun_group_ = queue_.front().group;
  queued_ -= queue_.front().size;
  queue_.pop_front();
  last_active_ = now;
}

void Stream::OnDropped(Time now, std::size_t packets) {
  if (packets > 0) last_active_ = now;
  for (; packets > 0 && !queue_.empty(); --packets) {
    ++counters_.packets_dropped;
    if (queue_.front().group) dropped_group_ = queue_.front().group;
    queued_ -= queue_.front().size;
    queue_.pop_front();
  }
}

std::size_t Stream::LatePackets(Time now, DataRate rate) const {
  if (queue_.empty()) return 0;
  if (!queue_.front().starts_frame) return StuckPackets(now);
  std::optional<std::uint32_t> dropped = dropped_group_;
  auto unit = queue_.begin();
  while (unit != queue_.end()) {
    const auto next = UnitEnd(unit);
    const bool group_dropped = unit->group && unit->group == dropped;
    if (!group_dropped && !Late(now, rate, unit, next)) break;
    if (unit->group) dropped = unit->group;
    unit = next;
  }
  return static_cast<std::size_t>(unit - queue_.begin());
}

/// Returns how many packets of a frame are stuck after a part of the frame was sent. The rest is
/// sent, because half a frame is useless, unless its first packet has waited kBegunStay *
/// max_queue_delay.
std::size_t Stream::StuckPackets(Time now) const {
  const Duration age = now - queue_.front().queued;
  if (age < kBegunStay * p_.max_queue_delay) return 0;
  const auto next =
      std::find_if(queue_.begin(), queue_.end(), [](const Queued& q) { return q.starts_frame; });
  const auto rest = static_cast<std::size_t>(next - queue_.begin());
  // The last packet of the frame is kept, because a receiver that reports at the end of frames
  // waits for it.
  const bool keeps_last =
      p_.feedback_interval > Duration{0} && age < 2 * kBegunStay * p_.max_queue_delay;
  return keeps_last ? rest - 1 : rest;
}

Stream::Queue::const_iterator Stream::UnitEnd(Queue::const_iterator unit) const {
  return std::find_if(std::next(unit), queue_.end(), [unit](const Queued& q) {
    return q.starts_frame && !(q.group && q.group == unit->group);
  });
}

/// Returns true if the access unit from `unit` to `next` would be late at `rate`. Assumes that a
/// group grows to the size and the time span of the previous group.
bool Stream::Late(Time now, DataRate rate, Queue::const_iterator unit,
                  Queue::const_iterator next) const {
  DataSize size;
  for (auto packet = unit; packet != next; ++packet) size += packet->size;
  Time last = std::prev(next)->queued;
  if (unit->group && unit->group == this_group_.id) {
    size += std::max(DataSize(), last_group_.size - this_group_.size);
    last = std::max(last, this_group_.first + last_group_.span());
  }
  const Time middle = unit->queued + (last - unit->queued) / 2;
  return now + size / rate > middle + p_.max_queue_delay * (Begun(*unit) ? kBegunStay : 1);
}

void Stream::NoteGroup(Time now, const QueuedPacket& packet) {
  if (packet.group != this_group_.id) {
    last_group_ = this_group_;
    this_group_ = {packet.group, DataSize(), now, now};
  }
  this_group_.size += packet.size;
  this_group_.last = now;
}

Duration Stream::media_qdelay(Time now) const {
  return queue_.empty() ? Duration{0} : now - queue_.front().queued;
}

bool Stream::sends_scans() const { return frame_period_ >= kScanPeriod; }

DataSize Stream::backlog(Time now) const {
  const Duration left =
      sends_scans() ? std::clamp(frame_begin_ + frame_period_ - now, Duration{0}, frame_period_)
                    : frame_period_;
  return std::max(DataSize(), queued_ - target_bitrate_ * left);
}

DataRate Stream::backlog_rate(Time now) const {
  return backlog(now) / (sends_scans() ? frame_period_ : p_.backlog_drain);
}

bool Stream::active(Time now) const {
  return !queue_.empty() || !last_active_ || now - *last_active_ < kInactive;
}

StreamStatistics Stream::statistics(Time now) const {
  StreamStatistics s = counters_;
  s.target_bitrate = target_bitrate_;
  s.sent_bitrate = sent_rate_.Rate(now);
  s.queued = queued_;
  s.media_qdelay = media_qdelay(now);
  return s;
}

}  // namespace lidar::scream
