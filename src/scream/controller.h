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
/// **The RTP queue** of each stream is a FIFO of the caller. The controller mirrors it by sizes:
/// OnQueued() appends to the mirror, OnSent() and OnDropped() take from its head. The caller does
/// the same with its packets, in the same order, and sends none in another way.
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
/// Take the time of OnSent() *before* the send call: a sender preempted within it would otherwise
/// see negative queue delay. After OnFeedback(), OnTimer() and OnQueued() read target_bitrate()
/// again. Times must not go backwards by more than reordering between threads does. A time before
/// the latest one counts as the latest one.
///
/// Not thread-safe, no callbacks; a caller with a lock holds it around each call.
///
/// The controller only calls its parts in order: `model/` measures the path, `response/` decides
/// what follows from the measurements, and `streams` shares the rate.
class Controller {
 public:
  explicit Controller(const Parameters& parameters) : p_(parameters) {}
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;

  // Streams. All may be called at any time.
  StreamId AddStream(const StreamConfig& config);
  void ConfigureStream(StreamId stream, const StreamConfig& config);
  /// Forgets the stream's queued packets; its packets in flight still count.
  void RemoveStream(StreamId stream) { streams_.Remove(stream); }

  // Events:
  void OnQueued(Time now, StreamId stream, const QueuedPacket& packet);
  void OnSent(Time now, StreamId stream, const SentPacket& packet);
  /// The caller dropped the first `packets` of the stream's queue.
  void OnDropped(Time now, StreamId stream, std::size_t packets);
  /// The packet at the head of the queue is not sent, because another path delivered it.
  void OnUnneeded(Time now, StreamId stream);
  /// Takes parsed feedback of the peer, whose source address the caller has checked.
  FeedbackResult OnFeedback(Time now, const rtcp::CongestionFeedback& feedback);
  /// Call it at NextTimer() or later; more calls do no harm.
  void OnTimer(Time now);
  /// The peer's address changed. Forgets base delay and RTT, probes ECN anew, and restarts from the
  /// streams' start bitrates.
  void OnRouteChange(Time now);

  // Decisions:
  // Returns the stream that may send next, and the time. The time is in the future if the pacer or
  // a closed window delays the packet. Returns nothing while all queues are empty.
  std::optional<SendDecision> NextSend(Time now) const;
  /// Returns how many packets at the head of the queue are too late. An access unit, or its group,
  /// is late as a whole if its last packet would leave later than `max_queue_delay` after the
  /// middle of its capture. The limit is five times as long if the group has begun to leave. Late
  /// units behind a late unit count, too. The rest of a unit that has begun is late when its first
  /// packet has waited five times `max_queue_delay`. While packets in flight are overdue, the
  /// limits are longer by the time that the bytes in flight take at the rate before the gap, up to
  /// half of `max_queue_delay`.
  std::size_t LatePackets(Time now, StreamId stream) const;
  /// Returns when to call OnTimer() next.
  Time NextTimer() const;
  /// Bitrates that one stream and all streams may send, with IP, UDP and RTP headers.
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
  SteadyTime clock_;  // the caller's clock; all times inside are steady
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
