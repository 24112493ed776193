// SPDX-License-Identifier: LGPL-2.1-or-later
// A media stream: the mirror of its RTP queue, its frames, and its share of the rate.
#pragma once
#include <deque>
#include <optional>
#include <set>

#include "src/base/rate_meter.h"
#include "src/scream/parameters.h"
#include "src/scream/statistics.h"
#include "src/scream/stream_config.h"

namespace lidar::scream {

class Stream {
 public:
  Stream(const Parameters& parameters, const StreamConfig& config);

  void Configure(const StreamConfig& config) { config_ = config; }
  /// Returns true if the packet ends a frame.
  bool OnQueued(Time now, const QueuedPacket& packet);
  /// Removes the packet at the head of the queue.
  void OnSent(Time now, std::uint32_t ssrc, DataSize size);
  void OnDropped(Time now, std::size_t packets);
  /// Removes the packet at the head of the queue, because another path has delivered it. The rest
  /// of the packet's group is still useful.
  void OnUnneeded(Time now);
  /// Returns how many packets at the head are late if the queue drains at `rate`; see
  /// Controller::LatePackets().
  std::size_t LatePackets(Time now, DataRate rate) const;

  bool empty() const { return queue_.empty(); }
  DataSize head_size() const { return queue_.front().size; }
  /// Returns true if no packet of the first access unit in the queue, or of its group, has been
  /// sent.
  bool at_start() const { return queue_.front().starts_frame && !Begun(queue_.front()); }
  DataSize queued() const { return queued_; }
  /// Returns the queued bytes that exceed what the target carries until the next frame. Unless
  /// frames are whole scans, the next frame counts as a full period away.
  DataSize backlog(Time now) const;
  /// Returns the reduction of the target that removes the backlog within backlog_drain or, if
  /// frames are whole scans, within a frame period.
  DataRate backlog_rate(Time now) const;
  /// Returns the age of the oldest packet in the queue.
  Duration media_qdelay(Time now) const;
  bool Owns(std::uint32_t ssrc) const { return ssrcs_.count(ssrc) > 0; }

  const StreamConfig& config() const { return config_; }
  double queue_compensation() const { return rate_adjust_factor_ + frame_size_dev_; }
  Duration frame_period() const { return frame_period_; }
  /// Notes that a gap or a drop of the capacity has caused the queue. The reduction of the target
  /// that this queue causes then fades fast.
  void OnSuddenBacklog() { sudden_backlog_ = !queue_.empty() || rate_adjust_factor_ > 0; }
  /// Starts to measure the time without packets, unless this time is already measured.
  void NoteTime(Time now) { last_active_ = last_active_.value_or(now); }
  /// Returns true if the stream has packets, or had some recently.
  bool active(Time now) const;
  /// Returns true if the last Allocate() found the stream active.
  bool counts() const { return counts_; }
  void set_counts(bool counts) { counts_ = counts; }
  DataRate target_bitrate() const { return target_bitrate_; }
  void set_target_bitrate(DataRate target) { target_bitrate_ = target; }
  void OnAcked(bool ce) { counters_.packets_ce += ce ? 1 : 0; }
  void OnLost() { ++counters_.packets_lost; }
  StreamStatistics statistics(Time now) const;
  /// The sum of sent bits, each divided by the target bitrate, by which Streams schedules the
  /// streams.
  double virtual_time = 0;

 private:
  /// Returns true if frames are so rare that each frame forms a queue by itself.
  bool sends_scans() const;
  struct Queued {
    DataSize size;
    Time queued{};
    bool starts_frame = false;
    std::optional<std::uint32_t> group = std::nullopt;
  };
  /// A group of access units.
  struct Group {
    std::optional<std::uint32_t> id;
    DataSize size;
    Time first{}, last{};
    Duration span() const { return last - first; }
  };
  void TakeHead(Time now);
  void OnFrame(Time now);
  std::size_t StuckPackets(Time now) const;
  void NoteGroup(Time now, const QueuedPacket& packet);
  using Queue = std::deque<Queued>;
  bool Begun(const Queued& packet) const { return packet.group && packet.group == begun_group_; }
  /// Returns the position after the access unit at `unit`, or after its group.
  Queue::const_iterator UnitEnd(Queue::const_iterator unit) const;
  bool Late(Time now, DataRate rate, Queue::const_iterator unit, Queue::const_iterator next) const;

  const Parameters& p_;
  StreamConfig config_;
  Queue queue_;
  DataSize queued_;
  std::set<std::uint32_t> ssrcs_;
  mutable RateMeter sent_rate_{1s};
  DataRate target_bitrate_;
  bool counts_ = true;
  // The SSRC that sends markers. Its packets form the frames.
  std::optional<std::uint32_t> media_ssrc_;
  std::optional<std::uint32_t> frame_timestamp_;
  DataSize frame_size_;
  std::optional<std::uint32_t> begun_group_, dropped_group_;
  Group this_group_, last_group_;
  Time frame_begin_{};  // time of the newest frame's first packet
  std::optional<Time> last_frame_;
  std::optional<Time> last_active_;
  Duration frame_period_ = 20ms;
  bool frame_period_known_ = false;
  double rate_adjust_factor_ = 0;
  double frame_size_dev_ = 0;
  bool sudden_backlog_ = false;
  StreamStatistics counters_;
};

}  // namespace lidar::scream
