// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/scream/streams.h"

#include <algorithm>

namespace lidar::scream {

StreamId Streams::Add(const StreamConfig& config) {
  const StreamId id = next_id_++;
  streams_.emplace(id, Stream(p_, config)).first->second.virtual_time = virtual_now_;
  return id;
}

const Stream* Streams::Find(StreamId id) const {
  const auto it = streams_.find(id);
  return it == streams_.end() ? nullptr : &it->second;
}

std::optional<StreamId> Streams::Owner(std::uint32_t ssrc) const {
  for (const auto& [id, stream] : streams_)
    if (stream.Owns(ssrc)) return id;
  return std::nullopt;
}

std::optional<StreamId> Streams::Next() const {
  std::optional<StreamId> next;
  std::pair<bool, double> earliest;
  for (const auto& [id, stream] : streams_) {
    const std::pair<bool, double> turn{!stream.config().strict, stream.virtual_time};
    if (stream.empty() || (next && turn >= earliest)) continue;
    next = id;
    earliest = turn;
  }
  return next;
}

/// Call it when an idle stream queues a packet. The stream gets no credit for the time without
/// packets.
void Streams::OnQueued(Stream* stream) {
  stream->virtual_time = std::max(stream->virtual_time, virtual_now_);
}

void Streams::OnSent(Time now, StreamId id, std::uint32_t ssrc, DataSize size) {
  Stream* stream = Find(id);
  if (stream == nullptr) return;
  stream->OnSent(now, ssrc, size);
  // Strict streams do not advance the virtual time of the others.
  if (!stream->config().strict) virtual_now_ = stream->virtual_time;
  const double weight = std::max(1.0, stream->target_bitrate().bits_per_second());
  stream->virtual_time += size.bits() / weight;
}

void Streams::OnReport(const AckSummary& acks) {
  for (const AckedPacket& packet : acks.acked)
    if (Stream* stream = Find(packet.stream)) stream->OnAcked(packet.arrived_ecn == Ecn::kCe);
  for (const SentRecord& packet : acks.lost)
    if (Stream* stream = Find(packet.stream)) stream->OnLost();
}

void Streams::Allocate(Time now, DataRate total) {
  std::vector<Share> open;
  DataRate left = total;
  if (now != Time{})  // zero before the first event
    for (auto& [id, stream] : streams_) stream.NoteTime(now);
  const bool any_active = std::any_of(streams_.begin(), streams_.end(),
                                      [now](const auto& s) { return s.second.active(now); });
  for (auto& [id, stream] : streams_) stream.set_counts(!any_active || stream.active(now));
  // The needs above the minima are met in the same proportion for all streams, as far as the path
  // can carry them.
  const DataRate least = min_bitrate();
  const DataRate extra = needed_bitrate() - least;
  const double need_share = extra > DataRate() ? std::clamp((total - least) / extra, 0.0, 1.0) : 0;
  for (auto& [id, stream] : streams_) {
    const StreamConfig& c = stream.config();
    if (!stream.counts()) {
      stream.set_target_bitrate(c.need());
      continue;
    }
    const DataRate floor = c.min_bitrate + (c.need() - c.min_bitrate) * need_share;
    stream.set_target_bitrate(floor);
    left = left - floor;
    // The target of all streams leaves room for all their queues. The queue of a stream lowers only
    // the share of this stream.
    const double weight =
        std::max(1e-6, c.priority) / (p_.target_rate_divisor + stream.queue_compensation());
    open.push_back({&stream, weight, floor, c.most()});
  }
  const auto others = std::stable_partition(
      open.begin(), open.end(), [](const Share& s) { return s.stream->config().strict; });
  left = Fill({open.begin(), others}, left);
  Fill({others, open.end()}, left);
}

/// Shares the rate `left` by weight. A stream at its maximum leaves the rest to the others. Returns
/// the rate that remains.
DataRate Streams::Fill(std::vector<Share> open, DataRate left) {
  while (left.bits_per_second() > 1 && !open.empty()) {
    double weights = 0;
    for (const Share& s : open) weights += s.weight;
    double fraction = 1;  // part of `left` until the first stream is full
    for (const Share& s : open)
      fraction = std::min(fraction, (s.max - s.rate) / (left * (s.weight / weights)));
    const DataRate given = left * fraction;
    for (Share& s : open) {
      s.rate = s.rate + given * (s.weight / weights);
      s.stream->set_target_bitrate(std::min(s.rate, s.max));
    }
    left = left - given;
    const auto full = [](const Share& s) { return (s.max - s.rate).bits_per_second() < 1; };
    open.erase(std::remove_if(open.begin(), open.end(), full), open.end());
    if (fraction >= 1) break;
  }
  return left;
}

/// Lowers the targets of streams with long backlogs. A stream with a much shorter backlog keeps its
/// target, because it may only wait behind another stream.
void Streams::LeaveRoomForBacklogs(Time now) {
  const auto wait = [now](const Stream& s) {
    return s.backlog(now) / std::max(s.target_bitrate(), DataRate::BitsPerSecond(1));
  };
  Duration longest{0};
  for (const auto& [id, stream] : streams_) longest = std::max(longest, wait(stream));
  for (auto& [id, stream] : streams_) {
    if (wait(stream) < longest / 2) continue;
    const DataRate target = stream.target_bitrate();
    const StreamConfig& c = stream.config();
    const DataRate floor = std::min(target, c.need());
    stream.set_target_bitrate(std::max(floor, target - stream.backlog_rate(now)));
  }
}

Duration Streams::frame_period() const {
  Duration period = 20ms;
  DataRate highest;
  for (const auto& [id, s] : streams_) {
    if (!s.counts() || s.target_bitrate() < highest) continue;
    highest = s.target_bitrate();
    period = s.frame_period();
  }
  return period;
}

double Streams::queue_compensation() const {
  const double sum = target_bitrate().bits_per_second();
  double weighted = 0;
  for (const auto& [id, s] : streams_)
    if (s.counts()) weighted += s.queue_compensation() * s.target_bitrate().bits_per_second();
  return sum > 0 ? weighted / sum : 0;
}

Duration Streams::media_qdelay(Time now) const {
  Duration longest{0};
  for (const auto& [id, s] : streams_) longest = std::max(longest, s.media_qdelay(now));
  return longest;
}

}  // namespace lidar::scream
