// SPDX-License-Identifier: LGPL-2.1-or-later
// The sender's side of SCReAM v2. Events come with their time, and decisions are returned.
#pragma once
#include <cstdint>
#include <optional>

#include "src/base/steady_time.h"
#include "src/rtcp/ccfb.h"
#include "src/scream/model/path_model.h"
#include "src/scream/model/sent_history.h"
#include "src/scream/pacer.h"
#include "src/scream/parameters.h"
#include "src/scream/response/fast_increase.h"
#include "src/scream/response/gap_recovery.h"
#include "src/scream/response/outage.h"
#include "src/scream/response/reference_window.h"
#include "src/scream/response/send_window.h"
#include "src/scream/statistics.h"
#include "src/scream/stream_config.h"
#include "src/scream/streams.h"

namespace lidar::scream {

struct SendDecision {
  Time time{};  ///< not before this time; a past time means at once
  StreamId stream = 0;
  Ecn ecn = Ecn::kNotEct;  ///< ECN codepoint for the packet
};

/// Congestion control of one 5-tuple with any number of streams, each with any number of SSRCs.
///
/// **The RTP queue** of each stream is a FIFO that the caller keeps. The controller keeps a mirror
/// of it, which has only the sizes of the packets: OnQueued() appends to the mirror, and OnSent()
/// and OnDropped() remove from its head. The caller must change its FIFO in the same way and in the
/// same order, and must not send any other packets.
///
///     controller.OnQueued(now, stream, {ssrc, size, marker, rtp_timestamp});
///     for (;;) {
///       auto late = controller.LatePackets(now, stream);  // live input: whole late frames
///       if (late) { pop `late` packets; controller.OnDropped(now, stream, late); }
///       auto d = controller.NextSend(now);
///       if (!d) wait for a packet, feedback or NextTimer();
///       else if (d->time > now) wait until d->time, or one of those;
///       else { pop the head of d->stream; now = clock(); controller.OnSent(now, stream, packet);
///       send; }
///     }
///
/// Read the clock for OnSent() *before* the call that sends the packet. If the thread were
/// preempted in that call, a later time would make the queue delay negative. After OnFeedback(),
/// OnTimer() and OnQueued(), read target_bitrate() again. Times may go backwards only by a little,
/// as they do when several threads call in turn. A time before the latest time counts as the latest
/// time.
///
/// The controller is not thread-safe: a caller with several threads holds a lock during each call.
/// There are no callbacks.
///
/// The controller itself only calls its parts in order: `model/` measures the path, `response/`
/// decides how to react to the measurements, and `streams` shares the rate among the streams.
class Controller {
 public:
  explicit Controller(const Parameters& parameters) : p_(parameters) {}
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;

  // Streams. The methods below may be called at any time.
  StreamId AddStream(const StreamConfig& config);
  void ConfigureStream(StreamId stream, const StreamConfig& config);
  /// Removes the stream and its queued packets. Its packets in flight still count.
  void RemoveStream(StreamId stream) { streams_.Remove(stream); }

  // Events:
  void OnQueued(Time now, StreamId stream, const QueuedPacket& packet);
  void OnSent(Time now, StreamId stream, const SentPacket& packet);
  /// Call it after dropping the first `packets` packets of the stream's queue.
  void OnDropped(Time now, StreamId stream, std::size_t packets);
  /// Call it instead of OnSent() if the packet at the head of the queue is not sent, because
  /// another path has delivered it.
  void OnUnneeded(Time now, StreamId stream);
  /// Handles a parsed report of the peer. The caller must have checked the report's source address.
  FeedbackResult OnFeedback(Time now, const rtcp::CongestionFeedback& feedback);
  /// Call it at NextTimer() or later; more calls do no harm.
  void OnTimer(Time now);
  /// Call it when the peer's address has changed. Forgets the base delay and the round-trip time,
  /// tests ECN anew, and restarts from the streams' start bitrates.
  void OnRouteChange(Time now);

  // Decisions:
  // Returns the stream that may send next, and the time at which it may send. The time is in the
  // future if the pacer or a closed window delays the packet. Returns nothing if all queues are
  // empty.
  std::optional<SendDecision> NextSend(Time now) const;
  /// Returns how many packets at the head of the queue are too late. An access unit, or a group of
  /// access units, is late as a whole if its last packet would be sent later than `max_queue_delay`
  /// after the middle of its capture. This limit is five times as long if a part of the group has
  /// been sent. If a unit is late, late units that follow it count, too. If a part of a unit has
  /// been sent, its rest is late when the first packet of the rest has waited five times
  /// `max_queue_delay`. While packets in flight are overdue, the limits are extended by the time
  /// that the bytes in flight take at the rate before the gap, but at most by half of
  /// `max_queue_delay`.
  std::size_t LatePackets(Time now, StreamId stream) const;
  /// Returns when to call OnTimer() next.
  Time NextTimer() const;
  /// Returns the bitrate that one stream, or all streams together, may send, including the headers
  /// of IP, UDP and RTP.
  DataRate target_bitrate(StreamId stream) const;
  DataRate target_bitrate() const { return streams_.target_bitrate(); }
  /// Returns the stream that queued or sent `ssrc`, for events that name an SSRC.
  std::optional<StreamId> FindStream(std::uint32_t ssrc) const { return streams_.Owner(ssrc); }

  // Observation:
  Statistics statistics(Time now) const;
  StreamStatistics stream_statistics(Time now, StreamId stream) const;
  EcnState ecn_state() const { return path_.ecn().state(); }

 private:
  Time Advance(Time caller_now);
  void TakeOutageRestart(Time now);
  void MeasurePath(Time now, const AckSummary& acks);
  void CountAcks(const AckSummary& acks);
  void Respond(Time now, const AckSummary& acks);
  bool RespondToDrop(Time now);
  void RespondToSignals(Time now, const AckSummary& acks);
  CongestionSignals Signals(Time now, const AckSummary& acks) const;
  void Count(RateReason reason);
  void StartWindow() { window_.Start(streams_.start_bitrate(), path_.rtt().smoothed()); }
  void UpdateTarget(Time now);
  void TakeGapRestart(Time now);
  void UpdatePacer(Time now);
  DataRate WindowRate(Time now, double queue_compensation) const;
  DataRate WindowTarget(Time now) const;
  bool CongestedLately() const;
  DataRate QueueRate(const Stream& stream) const;
  DataRate AskedTarget(Time now, DataRate allowed) const;
  Duration Lateness() const;
  bool Overdue(Time now) const;
  bool Stalled(Time now) const;
  Duration WaitBehindGap(Time now) const;
  bool Holds(const Stream& stream, Time now) const;

  const Parameters p_;
  SteadyTime clock_;  // converts the caller's times to steady times, which all members use
  Time now_{};
  Streams streams_{p_};
  SentHistory history_;
  PathModel path_{p_};
  ReferenceWindow window_{p_};
  FastIncrease fast_increase_{p_};
  Outage outage_{p_};
  GapRecovery gap_recovery_{p_};
  SendWindow send_window_{p_};
  Pacer pacer_{p_};
  bool started_ = false;    // a round trip was measured
  DataRate window_target_;  // from the window; the sum of the streams' targets may be higher
  Time last_housekeeping_{};
  Statistics counters_;
};

}  // namespace lidar::scream
