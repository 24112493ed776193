// SPDX-License-Identifier: LGPL-2.1-or-later
// All streams of a controller: decides which stream sends next, and shares the rate among the
// streams.
#pragma once
#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "src/scream/model/sent_history.h"
#include "src/scream/stream.h"

namespace lidar::scream {

class Streams {
 public:
  explicit Streams(const Parameters& parameters) : p_(parameters) {}

  StreamId Add(const StreamConfig& config);
  void Remove(StreamId id) { streams_.erase(id); }
  const Stream* Find(StreamId id) const;
  Stream* Find(StreamId id) { return const_cast<Stream*>(std::as_const(*this).Find(id)); }
  std::optional<StreamId> Owner(std::uint32_t ssrc) const;

  /// Returns the stream that sends next. Strict streams are first. The other streams share by
  /// weighted fair queueing, with their target bitrates as weights.
  std::optional<StreamId> Next() const;
  void OnSent(Time now, StreamId id, std::uint32_t ssrc, DataSize size);
  void OnQueued(Stream* stream);
  /// Counts acknowledged and lost packets by stream.
  void OnReport(const AckSummary& acks);

  /// Sets the targets of all streams. Each stream gets its minimum, and the same fraction of what
  /// it needs above the minimum. The rest is shared by priority, up to the maximum of each stream.
  /// A silent stream gets a target that equals its need but is not part of `total`, unless all
  /// streams are silent.
  void Allocate(Time now, DataRate total);
  /// Lowers the targets of the streams with the longest backlogs by Stream::backlog_rate(), but not
  /// below what the streams need.
  void LeaveRoomForBacklogs(Time now);
  void OnSuddenBacklog() {
    for (auto& [id, stream] : streams_) stream.OnSuddenBacklog();
  }
  // Sums over the streams that are not silent, or over all streams if all are silent.
  DataRate min_bitrate() const {
    return Sum([](const Stream& s) { return s.config().min_bitrate; });
  }
  DataRate needed_bitrate() const {
    return Sum([](const Stream& s) { return s.config().need(); });
  }
  DataRate max_bitrate() const {
    return std::min(Sum([](const Stream& s) { return s.config().most(); }),
                    std::max(p_.max_total_bitrate, min_bitrate()));
  }
  DataRate start_bitrate() const {
    return Sum([](const Stream& s) { return s.config().start_bitrate; });
  }
  DataRate target_bitrate() const {
    return Sum([](const Stream& s) { return s.target_bitrate(); });
  }
  /// Returns the frame period of the stream with the highest target.
  Duration frame_period() const;
  /// Returns the mean of rate_adjust_factor + frame_size_dev, weighted by the targets of the
  /// streams.
  double queue_compensation() const;
  DataSize queued() const {
    DataSize sum;
    for (const auto& [id, s] : streams_) sum += s.queued();
    return sum;
  }
  Duration media_qdelay(Time now) const;
  bool empty() const { return !Next(); }

 private:
  /// A stream, and the part of the rate that it has got so far.
  struct Share {
    Stream* stream;
    double weight;
    DataRate rate;
    DataRate max;
  };
  static DataRate Fill(std::vector<Share> open, DataRate left);
  template <class Rate>
  DataRate Sum(Rate rate) const {
    DataRate sum;
    for (const auto& [id, s] : streams_)
      if (s.counts()) sum = sum + rate(s);
    return sum;
  }
  const Parameters& p_;
  std::map<StreamId, Stream> streams_;
  StreamId next_id_ = 0;
  double virtual_now_ = 0;
};

}  // namespace lidar::scream
