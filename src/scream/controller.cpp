// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/scream/controller.h"

#include <algorithm>

#include "src/scream/response/adaptive_pacing.h"
#include "src/scream/response/capacity_drop.h"
#include "src/scream/response/isolated_loss.h"
#include "src/scream/response/shared_link.h"
#include "src/scream/response/source_limit.h"

namespace lidar::scream {
namespace {

constexpr Duration kHousekeeping = 50ms;
/// A caller that is late by this much was stopped, or its clock was set.
constexpr Duration kStandstill = 500ms;
constexpr double kDriftRateScale = 0.5;
/// The window about matches the link's capacity for this time after a sign of congestion.
constexpr Duration kCongestedLately = 300ms;
/// A longer silence of the receiver is not a gap of the link.
constexpr Duration kLongestSilence = 2s;
/// A report that is late by more than this shows that the link is stalled.
constexpr Duration kOverdue = 5ms;

}  // namespace

/// Returns the steady time. After a pause of the caller, gives up the packets in flight, because
/// the pause, and not the path, has delayed their feedback.
Time Controller::Advance(Time caller_now) {
  const Time now = clock_.From(caller_now);
  // While packets are in flight, the caller must call at each NextTimer(), so a long silence is a
  // pause.
  const Duration silence = now - now_;
  now_ = std::max(now_, now);
  if (p_.extensions.evidence && silence > kHousekeeping + kStandstill &&
      history_.bytes_in_flight().bytes() > 0) {
    history_.Expire(now_);
    outage_.Restart(now_);
    gap_recovery_.Reset();
    last_housekeeping_ = now_;
  }
  return now_;
}

StreamId Controller::AddStream(const StreamConfig& config) {
  const StreamId id = streams_.Add(config);
  UpdateTarget(now_);
  return id;
}

void Controller::ConfigureStream(StreamId id, const StreamConfig& config) {
  Stream* stream = streams_.Find(id);
  if (stream == nullptr) return;
  stream->Configure(config);
  UpdateTarget(now_);
}

void Controller::OnQueued(Time now, StreamId id, const QueuedPacket& packet) {
  now = Advance(now);
  Stream* stream = streams_.Find(id);
  if (stream == nullptr) return;
  if (streams_.empty()) pacer_.OnIdleEnd(now);
  if (stream->empty()) streams_.OnQueued(stream);
  if (stream->OnQueued(now, packet)) UpdateTarget(now);
}

void Controller::OnSent(Time now, StreamId id, const SentPacket& packet) {
  now = Advance(now);
  if (!started_ && counters_.packets_sent == 0) StartWindow();
  if (history_.bytes_in_flight().bytes() == 0) outage_.Restart(now);
  history_.OnSent(packet.ssrc, packet.seq, {id, packet.size, now, packet.ecn});
  path_.OnSent(now, packet.size, packet.ecn, history_.bytes_in_flight());
  streams_.OnSent(now, id, packet.ssrc, packet.size);
  pacer_.OnSent(now, packet.size);
  send_window_.OnSent(now);
  ++counters_.packets_sent;
  counters_.bytes_sent += packet.size;
}

void Controller::OnDropped(Time now, StreamId id, std::size_t packets) {
  now = Advance(now);
  if (Stream* stream = streams_.Find(id)) stream->OnDropped(now, packets);
  counters_.packets_dropped += packets;
}

void Controller::OnUnneeded(Time now, StreamId id) {
  now = Advance(now);
  if (Stream* stream = streams_.Find(id)) stream->OnUnneeded(now);
  ++counters_.packets_dropped;
}

FeedbackResult Controller::OnFeedback(Time now, const rtcp::CongestionFeedback& feedback) {
  now = Advance(now);
  if (outage_.active()) history_.Expire(now);
  AckSummary acks;
  const FeedbackResult result = history_.OnFeedback(now, feedback, &acks);
  if (result == FeedbackResult::kImplausible) ++counters_.feedback_ignored;
  if (result != FeedbackResult::kAccepted) return result;
  ++counters_.feedback_accepted;
  if (!acks.acked.empty()) TakeOutageRestart(now);
  MeasurePath(now, acks);
  CountAcks(acks);
  streams_.OnReport(acks);
  Respond(now, acks);
  UpdateTarget(now);
  return result;
}

void Controller::TakeOutageRestart(Time now) {
  const auto restart = outage_.OnFeedback(now);
  if (!restart) return;
  window_.Restart(std::max(window_.ref_wnd(), *restart));
  // Packets that the outage delayed arrive during the next round trip. They do not count, because
  // the restart was already the reaction to the outage.
  path_.evidence().BeginAt(now + path_.rtt().smoothed());
  fast_increase_.Restart();
}

void Controller::MeasurePath(Time now, const AckSummary& acks) {
  path_.OnRoundTrip(now, acks);
  history_.set_max_reordering_window(path_.rtt().smoothed());
  if (!started_ && path_.rtt().known()) {
    started_ = true;
    StartWindow();
  }
  path_.OnReport(now, acks, {window_.ref_wnd(), streams_.frame_period()});
}

void Controller::CountAcks(const AckSummary& acks) {
  for (const AckedPacket& packet : acks.acked) {
    if (packet.was_lost) ++counters_.packets_late;
    if (packet.arrived_ecn == Ecn::kCe) ++counters_.packets_ce;
    counters_.bytes_acked += packet.size;
  }
  counters_.packets_ce += acks.late_ce.size();
  counters_.packets_acked += acks.acked.size();
  counters_.packets_lost += acks.lost.size();
}

void Controller::Respond(Time now, const AckSummary& acks) {
  if (!RespondToDrop(now)) RespondToSignals(now, acks);
  TakeGapRestart(now);
  path_.EndRoundTrip(now);
}

void Controller::TakeGapRestart(Time now) {
  const auto restart = gap_recovery_.Update(now, path_, window_.ref_wnd());
  if (!restart) return;
  window_.Restart(restart->window);
  path_.OnGapEnd(now, restart->s_rtt, restart->l4s_alpha);
  streams_.OnSuddenBacklog();
  pacer_.OnGapEnd(now);
  fast_increase_.Restart();
  ++counters_.gaps;
}

bool Controller::RespondToDrop(Time now) {
  const auto window =
      WindowAfterDrop(now, p_, path_, window_, window_target_, streams_.frame_period());
  if (!window) return false;
  window_.Drop(now, *window);
  if (p_.extensions.evidence) path_.evidence().OnDropReaction(now);
  streams_.OnSuddenBacklog();
  fast_increase_.OnCongestion(now);
  Count(RateReason::kDrop);
  return true;
}

void Controller::RespondToSignals(Time now, const AckSummary& acks) {
  const CongestionSignals signals = Signals(now, acks);
  // Fast growth waits until the backlog from recent congestion has left the streams' queues.
  if (streams_.media_qdelay(now) <= streams_.frame_period() || !CongestedLately())
    fast_increase_.Update(now, path_.Round(streams_.frame_period()));
  const RateReason reason = window_.Update(now, signals);
  if (reason == RateReason::kLoss && p_.extensions.evidence) path_.evidence().OnLossReaction(now);
  if (reason != RateReason::kIncrease) fast_increase_.OnCongestion(now);
  Count(reason);
  if (window_target_ >= streams_.max_bitrate())
    window_.Limit(std::max(path_.max_in_flight().longest(), BurstWindow(p_, path_, streams_)));
}

CongestionSignals Controller::Signals(Time now, const AckSummary& acks) const {
  CongestionSignals s;
  s.loss_detected = path_.new_loss();
  s.loss_is_congestion = LossIsCongestion(p_, path_);
  s.data_units_marked = path_.new_mark();
  s.fast_growth = fast_increase_.growth(now, path_, streams_.frame_period());
  if (p_.extensions.capacity) s.earliness = path_.UnreportedTime() / 2;
  s.l4s_alpha = path_.l4s_alpha().value();
  s.is_l4s = p_.ecn == Ecn::kEct1 && !(p_.extensions.company && path_.classic_ecn().found());
  s.qdelay = path_.queue_delay().qdelay();
  s.qdelay_avg = path_.queue_delay().qdelay_avg();
  s.qdelay_avg_falls = path_.queue_delay().qdelay_avg_falls();
  s.ref_wnd_delay_scale = path_.queue_delay().ref_wnd_delay_scale();
  s.boldness = BesideOthers(p_, path_, now);
  s.s_rtt = path_.rtt().smoothed();
  s.max_bytes_in_flight = path_.max_in_flight().current();
  s.max_bytes_in_flight_prev = path_.max_in_flight().previous();
  s.capacity_window = path_.measured_capacity() * (path_.rtt().min() + path_.marking_onset()) *
                      (p_.target_rate_divisor + streams_.queue_compensation());
  s.bytes_newly_acked = acks.bytes_newly_acked;
  s.bytes_newly_acked_ce = std::min(acks.bytes_newly_acked_ce, acks.bytes_newly_acked);
  s.target_bitrate = window_target_;
  s.target_bitrate_max = HoldsBurstsBack(p_, path_, streams_, window_.ref_wnd())
                             ? DataRate::Infinite()
                             : streams_.max_bitrate();
  s.acked_bitrate = path_.acked_rate(now);
  return s;
}

void Controller::Count(RateReason reason) {
  counters_.reason = reason;
  if (reason == RateReason::kLoss) ++counters_.loss_events;
  if (reason == RateReason::kCe) ++counters_.ce_events;
  if (reason == RateReason::kDelay) ++counters_.delay_events;
  if (reason == RateReason::kDrop) ++counters_.capacity_drops;
  if (reason == RateReason::kTimeout) ++counters_.feedback_timeouts;
}

void Controller::UpdateTarget(Time now) {
  const DataRate allowed = WindowTarget(now);
  streams_.Allocate(now, AskedTarget(now, allowed));
  if (p_.extensions.capacity && started_) streams_.LeaveRoomForBacklogs(now);
  window_target_ = std::clamp(allowed, streams_.min_bitrate(), streams_.max_bitrate());
  UpdatePacer(now);
}

void Controller::UpdatePacer(Time now) {
  const Duration period = streams_.frame_period();
  const double headroom = PacingHeadroom(p_, period, PacingReserve(p_, path_, now));
  pacer_.Update(window_target_, streams_.max_bitrate(), headroom, RelaxedPace(p_, path_));
  pacer_.set_ripple(PacingRipple(p_, path_));
  if (!p_.extensions.capacity) return;
  if (started_ && path_.L4sWorks(now))
    pacer_.LimitQueue(
        std::max(p_.rate_pace_min, WindowRate(now, 0) * BesideOthers(p_, path_, now).pace),
        FromSeconds(Seconds(period) * (1 - 1 / headroom)));
  else
    pacer_.LimitQueue(DataRate::Infinite(), Duration{0});
  if (streams_.media_qdelay(now) > period)
    pacer_.RaiseTo(DrainRate(p_, now, window_.ref_wnd(), history_.bytes_in_flight(), path_));
}

DataRate Controller::WindowRate(Time now, double queue_compensation) const {
  // During an outage, the round trip counts as at least the time without feedback.
  const Duration s_rtt = std::max(path_.rtt().smoothed(), outage_.Silence(now));
  return window_.TargetBitrate(s_rtt, queue_compensation);
}

DataRate Controller::WindowTarget(Time now) const {
  if (!started_) return streams_.start_bitrate();
  const DataRate target = WindowRate(now, streams_.queue_compensation());
  return now < path_.half_rate_until() ? target * kDriftRateScale : target;
}

/// Returns the target for encoders. While the link is stalled, the target is below the window's
/// rate, because new data would have to wait. The target is not below what the encoders need,
/// unless the receiver has been silent for long.
DataRate Controller::AskedTarget(Time now, DataRate allowed) const {
  DataRate asked = allowed;
  if (p_.extensions.gaps && started_ && Stalled(now)) asked = asked * p_.stall_share;
  if (p_.extensions.gaps && outage_.Silence(now) < kLongestSilence)
    asked = std::max(asked, streams_.needed_bitrate());
  return std::min(asked, streams_.max_bitrate());
}

std::optional<SendDecision> Controller::NextSend(Time caller_now) const {
  const auto id = streams_.Next();
  if (!id) return std::nullopt;
  const Stream& stream = *streams_.Find(*id);
  const DataSize max = Holds(stream, std::max(now_, clock_.Peek(caller_now)))
                           ? DataSize()
                           : send_window_.Max(now_, window_.ref_wnd(), path_);
  const Time opens = send_window_.Opens(stream.head_size(), history_.bytes_in_flight(), max);
  return SendDecision{clock_.ToCaller(std::max(pacer_.next(), opens)), *id,
                      path_.ecn().codepoint()};
}

/// Returns how late a report may be on a healthy link. Such a link may have lost one report.
Duration Controller::Lateness() const { return 2 * path_.report_gap() + kOverdue; }

/// Returns true if the oldest packet in flight has waited longer than a round trip and a late
/// report can explain.
bool Controller::Overdue(Time now) const {
  const auto oldest = history_.oldest_in_flight();
  return oldest && now - *oldest > path_.rtt().smoothed() + Lateness();
}

/// Returns true during a gap, and at its start, when packets are overdue and no acknowledgements
/// arrive.
bool Controller::Stalled(Time now) const {
  return gap_recovery_.in_gap() || (Overdue(now) && outage_.Quiet(now) > Lateness());
}

/// Returns how much longer packets wait because of a gap. This is the greatest number of bytes in
/// flight during the last two round trips, divided by the rate before the gap.
Duration Controller::WaitBehindGap(Time now) const {
  const auto rate = gap_recovery_.rate_before();
  if (!rate || !Overdue(now)) return Duration{0};
  return path_.max_in_flight().lately() / *rate;
}

/// Returns true if the stream must not send, because too many packets are unsettled or the link is
/// stalled. While the link is stalled, a new frame stays in the stream's queue, where it can still
/// be dropped.
bool Controller::Holds(const Stream& stream, Time now) const {
  const bool stalled = p_.extensions.gaps && started_ && Overdue(now) && Stalled(now);
  return history_.full() || (stalled && stream.at_start());
}

bool Controller::CongestedLately() const {
  return now_ - window_.last_congestion_detected_time() < kCongestedLately;
}

/// Returns the highest rate at which the stream's queue can drain. The rate is infinite in a gap,
/// or if there was no recent congestion, because the window then does not show the link's capacity.
DataRate Controller::QueueRate(const Stream& stream) const {
  if (gap_recovery_.in_gap() || outage_.active() || !CongestedLately()) return DataRate::Infinite();
  const DataRate known =
      std::max({window_target_, path_.acked_rate(now_), path_.measured_capacity()});
  const DataRate all = known * p_.link_may_be_faster;
  return all * (stream.target_bitrate() / std::max(streams_.target_bitrate(), p_.rate_pace_min));
}

std::size_t Controller::LatePackets(Time caller_now, StreamId id) const {
  const Stream* stream = streams_.Find(id);
  if (stream == nullptr) return 0;
  const Time now = clock_.Peek(caller_now);
  const Duration behind_gap = std::min(WaitBehindGap(now), p_.max_queue_delay / 2);
  return stream->LatePackets(now - behind_gap, QueueRate(*stream));
}

void Controller::OnTimer(Time now) {
  now = Advance(now);
  if (now < last_housekeeping_ + kHousekeeping) return;
  last_housekeeping_ = now;
  path_.OnTimer(now);
  if (started_ && history_.bytes_in_flight().bytes() > 0) {
    if (const auto window = outage_.OnTimer(now, window_.ref_wnd(), path_.rtt().smoothed(),
                                            streams_.frame_period())) {
      window_.Set(*window);
      gap_recovery_.OnSilence(now);
      Count(RateReason::kTimeout);
    }
  }
  UpdateTarget(now);
}

void Controller::OnRouteChange(Time now) {
  Advance(now);
  path_.Reset(now_);
  gap_recovery_.Reset();
  started_ = false;
  fast_increase_.Restart();
  history_.Expire(now_);
}

Time Controller::NextTimer() const {
  const bool idle = streams_.empty() && history_.bytes_in_flight().bytes() == 0;
  return idle ? Time::max() : clock_.ToCaller(last_housekeeping_ + kHousekeeping);
}

DataRate Controller::target_bitrate(StreamId id) const {
  const Stream* stream = streams_.Find(id);
  return stream == nullptr ? DataRate() : stream->target_bitrate();
}

Statistics Controller::statistics(Time now) const {
  const Time latest = std::max(clock_.Peek(now), now_);
  Statistics s = counters_;
  path_.Describe(latest, &s);
  s.ref_wnd = window_.ref_wnd();
  s.ref_wnd_i = window_.ref_wnd_i();
  s.bytes_in_flight = history_.bytes_in_flight();
  s.foreign_blocks = history_.foreign_blocks();
  s.qdelay_target = p_.qdelay_target_lo;
  s.target_bitrate = streams_.target_bitrate();
  s.pace_bitrate = pacer_.pace_bitrate();
  s.queued = streams_.queued();
  s.media_qdelay = streams_.media_qdelay(latest);
  return s;
}

StreamStatistics Controller::stream_statistics(Time now, StreamId id) const {
  const Stream* stream = streams_.Find(id);
  return stream == nullptr ? StreamStatistics{} : stream->statistics(clock_.Peek(now));
}

}  // namespace lidar::scream
