// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/scream/controller_impl.h"

namespace lidar::scream {
namespace {

constexpr Duration kHousekeeping = 50ms;
/// A caller that comes so much too late stood still, or its clock was set.
constexpr Duration kStandstill = 500ms;
constexpr double kDriftRateScale = 0.5;
/// quick_drain: how much faster than packets arrive a backlog may leave.
constexpr double kDrainMargin = 1.25;

}  // namespace

Controller::Impl::Impl(const Parameters& parameters) : p(parameters) {}

/// What was on the way while the caller stood still tells nothing about the path.
Time Controller::Impl::Advance(Time now) {
  const Duration silence = now - now_;  // of the caller: with data in flight it has to come often
  now_ = std::max(now_, now);
  if (silence > kHousekeeping + kStandstill && history_.bytes_in_flight().bytes() > 0) {
    history_.Expire(now_);
    last_feedback_ = last_housekeeping_ = now_;
  }
  return now_;
}

StreamId Controller::Impl::AddStream(const StreamConfig& config) {
  const StreamId id = streams.Add(config);
  UpdateTarget(now_);
  return id;
}

void Controller::Impl::ConfigureStream(StreamId id, const StreamConfig& config) {
  Stream* stream = streams.Find(id);
  if (stream == nullptr) return;
  stream->Configure(config);
  UpdateTarget(now_);
}

void Controller::Impl::OnQueued(Time now, StreamId id, const QueuedPacket& packet) {
  now = Advance(now);
  Stream* stream = streams.Find(id);
  if (stream == nullptr) return;
  if (streams.empty()) pacer_.OnIdleEnd(now);
  if (stream->empty()) streams.OnQueued(stream);
  if (stream->OnQueued(now, packet)) UpdateTarget(now);
}

void Controller::Impl::OnSent(Time now, StreamId id, const SentPacket& packet) {
  now = Advance(now);
  if (!started_ && last_sent_ == Time{}) StartWindow();
  if (history_.bytes_in_flight().bytes() == 0) last_feedback_ = now;  // silence starts here
  history_.OnSent(packet.ssrc, packet.seq, {id, packet.size, now, packet.ecn});
  max_in_flight_.Add(history_.bytes_in_flight());
  streams.OnSent(now, id, packet.ssrc, packet.size);
  pacer_.OnSent(now, packet.size);
  ecn.OnSent(now, packet.ecn);
  sent_rate_.Add(now, packet.size);
  ++counters_.packets_sent;
  counters_.bytes_sent += packet.size;
  last_sent_ = now;
}

void Controller::Impl::OnDropped(Time now, StreamId id, std::size_t packets) {
  Advance(now);
  if (Stream* stream = streams.Find(id)) stream->OnDropped(packets);
  counters_.packets_dropped += packets;
}

FeedbackResult Controller::Impl::OnFeedback(Time now, const CongestionFeedback& feedback) {
  now = Advance(now);
  if (window_before_outage_) history_.Expire(now);
  AckSummary summary;
  switch (history_.OnFeedback(now, feedback, &summary)) {
    case HistoryResult::kImplausible:
      ++counters_.feedback_ignored;
      return FeedbackResult::kImplausible;
    case HistoryResult::kNotOurs:
      return FeedbackResult::kNotOurs;
    case HistoryResult::kNothingNew:
      return FeedbackResult::kStale;
    case HistoryResult::kApplied:
      break;
  }
  ++counters_.feedback_accepted;
  if (!summary.acked.empty()) {
    last_feedback_ = now;
    if (window_before_outage_) EndOutage(now);
  }
  OnSummary(now, summary);
  return FeedbackResult::kAccepted;
}

void Controller::Impl::OnSummary(Time now, const AckSummary& summary) {
  MeasurePath(now, summary);
  CountAcks(now, summary);
  if (!started_ && rtt_.known()) {
    started_ = true;
    StartWindow();
  }
  ObserveCapacity(summary);
  MeasureReports(now, summary);
  const CongestionSignals signals = Signals(summary);
  if (streams.media_qdelay(now) <= streams.frame_period()) fast_increase_.Update(now, Round());
  if (!RespondToDrop(now, signals)) React(now, signals);
  if (max_in_flight_.Update(now, std::max(p.virtual_rtt, rtt_.smoothed()))) window_.RelaxPolicer();
  UpdateTarget(now);
}

void Controller::Impl::MeasurePath(Time now, const AckSummary& summary) {
  if (summary.rtt) rtt_.Add(now, *summary.rtt, SourceLimited());
  history_.set_max_reordering_window(rtt_.smoothed());
  const Duration excess = rtt_.last() - rtt_.min();
  for (const AckedPacket& packet : summary.acked)
    if (packet.arrival &&
        !queue_delay_.Add(now, packet.sent, *packet.arrival, excess, L4sWorks())) {
      ++counters_.clock_resets;
      busy_run_.Reset();
    }
  queue_delay_.Update(now, rtt_.smoothed(), competing_flows_.qdelay_target());
  if (queue_delay_.TakeDriftReset()) {
    ++counters_.clock_resets;
    half_rate_until_ = now + std::max<Duration>(5 * rtt_.smoothed(), 200ms);
  }
  competing_flows_.Update(now, queue_delay_.qdelay(), rtt_.smoothed(), !summary.lost.empty());
}

void Controller::Impl::CountAcks(Time now, const AckSummary& summary) {
  int marked = summary.late_ce;
  int answered = 0;
  acked_rate_.set_window(std::max(rtt_.smoothed(), 2 * streams.frame_period()));
  for (const AckedPacket& packet : summary.acked) {
    if (packet.arrived_ecn == Ecn::kCe) ++(packet.sent >= marks_answered_ ? marked : answered);
    if (packet.was_lost) ++counters_.packets_late;
    if (Stream* stream = streams.Find(packet.stream))
      stream->OnAcked(packet.arrived_ecn == Ecn::kCe);
    ecn.OnAcked(packet.ecn, packet.arrived_ecn);
    loss_rate_.Add(false, window_.ref_wnd());
    acked_rate_.Add(now, packet.size);
    counters_.bytes_acked += packet.size;
  }
  for (const LostPacket& packet : summary.lost) {
    loss_rate_.Add(true, window_.ref_wnd());
    if (Stream* stream = streams.Find(packet.stream)) stream->OnLost();
  }
  counters_.packets_acked += summary.acked.size();
  counters_.packets_lost += summary.lost.size();
  counters_.packets_ce += static_cast<std::uint64_t>(marked + answered);
  if (marked + answered > 0) last_mark_ = now;
  l4s_alpha_.Update(now, static_cast<int>(summary.acked.size()), marked, rtt_.smoothed(), Round());
}

CongestionSignals Controller::Impl::Signals(const AckSummary& summary) {
  CongestionSignals s;
  s.loss_detected =
      std::any_of(summary.lost.begin(), summary.lost.end(),
                  [this](const LostPacket& lost) { return lost.sent >= loss_answered_; });
  const auto is_ce = [this](const AckedPacket& a) {
    return a.arrived_ecn == Ecn::kCe && a.sent >= marks_answered_;
  };
  s.data_units_marked =
      summary.late_ce > 0 || std::any_of(summary.acked.begin(), summary.acked.end(), is_ce);
  s.loss_rate = loss_rate_.value();
  s.loss_rate_threshold = p.loss_rate_threshold;
  if (p.extensions.isolated_loss) {
    s.queue_at_loss = queue_delay_.qdelay() > p.isolated_loss_qdelay;
    if (p.ecn == Ecn::kEct1 && ecn.state() == EcnState::kCapable)
      s.loss_rate_threshold = std::max(p.loss_rate_threshold, p.isolated_loss_threshold);
  }
  if (p.extensions.fast_start)
    s.fast_growth = fast_increase_.growth(queue_delay_.qdelay(), L4sWorks());
  if (p.extensions.even_alpha) s.earliness = UnreportedTime() / 2;
  s.l4s_alpha = l4s_alpha_.value();
  s.is_l4s = p.ecn == Ecn::kEct1;
  s.qdelay = queue_delay_.qdelay();
  s.qdelay_avg = queue_delay_.qdelay_avg();
  s.qdelay_target = competing_flows_.qdelay_target();
  s.ref_wnd_delay_scale = queue_delay_.ref_wnd_delay_scale();
  s.s_rtt = rtt_.smoothed();
  s.max_bytes_in_flight = max_in_flight_.current();
  s.max_bytes_in_flight_prev = max_in_flight_.previous();
  s.bytes_newly_acked = summary.bytes_newly_acked;
  s.bytes_newly_acked_ce = std::min(summary.bytes_newly_acked_ce, summary.bytes_newly_acked);
  s.target_bitrate = streams.target_bitrate();
  s.target_bitrate_max = streams.max_bitrate();
  s.acked_bitrate = acked_rate_.Rate(now_);
  return s;
}

/// The window whose target bitrate is the streams' start bitrate; the draft leaves the start open.
void Controller::Impl::StartWindow() {
  const DataRate start = streams.start_bitrate();
  window_.Set(start * rtt_.smoothed() * p.target_rate_divisor *
              ((p.mss + p.packet_overhead) / p.mss));
}

void Controller::Impl::React(Time now, const CongestionSignals& signals) {
  switch (window_.Update(now, signals)) {
    case Reaction::kLoss:
      if (p.extensions.answered_signals) loss_answered_ = now;
      ++counters_.loss_events;
      counters_.reason = RateReason::kLoss;
      break;
    case Reaction::kCe:
      ++counters_.ce_events;
      counters_.reason = RateReason::kCe;
      break;
    case Reaction::kVirtualCe:
      ++counters_.delay_events;
      counters_.reason = RateReason::kDelay;
      break;
    case Reaction::kNone:
      counters_.reason = RateReason::kIncrease;
      LimitWindowAtMaxBitrate();
      return;
  }
  fast_increase_.OnCongestion(now);
  LimitWindowAtMaxBitrate();
}

/// At the maximum bitrate the window must not drift away from what is in flight.
void Controller::Impl::LimitWindowAtMaxBitrate() {
  if (streams.target_bitrate() < streams.max_bitrate()) return;
  const DataSize needed = streams.max_bitrate() * (rtt_.smoothed() + 1ms) *
                          (p.target_rate_divisor + streams.queue_compensation()) *
                          p.packet_pacing_headroom;
  window_.Limit(std::max(max_in_flight_.longest(), needed));
}

DataRate Controller::Impl::TargetOf(Time now) const {
  if (!started_) return streams.start_bitrate();
  // Through an outage the round trip is as long as nothing has come back.
  const Duration silence = window_before_outage_ ? now - last_feedback_ : Duration{0};
  const DataRate target =
      TargetBitrate(p, {window_.ref_wnd(), window_.ref_wnd_ratio(),
                        std::max(rtt_.smoothed(), silence), streams.queue_compensation()});
  return now < half_rate_until_ ? target * kDriftRateScale : target;
}

void Controller::Impl::UpdateTarget(Time now) {
  streams.Allocate(now, TargetOf(now));
  pacer_.Update(streams.target_bitrate(), streams.max_bitrate(), PacingHeadroom());
  if (p.extensions.quick_drain && streams.media_qdelay(now) > streams.frame_period())
    pacer_.RaiseTo(std::min(window_.ref_wnd() / rtt_.last() / p.target_rate_divisor,
                            acked_rate_.Rate(now) * kDrainMargin));
}

bool Controller::Impl::SourceLimited() const {
  return std::max(max_in_flight_.current(), max_in_flight_.previous()) *
             p.bytes_in_flight_head_room <
         window_.ref_wnd();
}

std::optional<SendDecision> Controller::Impl::NextSend(Time) const {
  const auto id = streams.Next();
  if (!id) return std::nullopt;
  const DataSize size = streams.Find(*id)->head_size();
  const DataSize in_flight = history_.bytes_in_flight();
  SendDecision decision{pacer_.next(), *id, ecn.codepoint()};
  const bool fits = in_flight.bytes() == 0 || in_flight + size <= MaxInFlight();
  // The minimum send rate keeps a closed window from waiting for ever for lost feedback.
  if (!fits) decision.time = std::max(decision.time, last_sent_ + size / p.rate_pace_min);
  return decision;
}

void Controller::Impl::OnTimer(Time now) {
  now = Advance(now);
  if (now < last_housekeeping_ + kHousekeeping) return;
  last_housekeeping_ = now;
  ecn.OnTimer(now);
  const bool waiting = history_.bytes_in_flight().bytes() > 0;
  if (p.extensions.feedback_timeout && started_ && waiting &&
      now - std::max(last_feedback_, last_timeout_) > FeedbackTimeout())
    OnFeedbackTimeout(now);
  UpdateTarget(now);
}

void Controller::Impl::OnRouteChange(Time now) {
  Advance(now);
  queue_delay_.Reset();
  rtt_.Reset();
  ecn.Reset();
  last_mark_.reset();
  started_ = false;
  fast_increase_.Restart();
  history_.Expire(now_);
}

Time Controller::Impl::NextTimer() const {
  const bool idle = streams.empty() && history_.bytes_in_flight().bytes() == 0;
  return idle ? Time::max() : last_housekeeping_ + kHousekeeping;
}

Statistics Controller::Impl::GetStatistics(Time now) const {
  Statistics s = counters_;
  s.ref_wnd = window_.ref_wnd();
  s.ref_wnd_i = window_.ref_wnd_i();
  s.bytes_in_flight = history_.bytes_in_flight();
  s.max_bytes_in_flight = max_in_flight_.longest();
  s.s_rtt = rtt_.known() ? rtt_.smoothed() : Duration{0};
  s.min_rtt = rtt_.known() ? rtt_.min() : Duration{0};
  s.qdelay = queue_delay_.qdelay();
  s.qdelay_avg = queue_delay_.qdelay_avg();
  s.qdelay_target = competing_flows_.qdelay_target();
  s.l4s_alpha = l4s_alpha_.value();
  s.ref_wnd_delay_scale = queue_delay_.ref_wnd_delay_scale();
  s.loss_rate = loss_rate_.value();
  s.max_policed_ref_wnd = window_.max_policed_ref_wnd();
  s.target_bitrate = streams.target_bitrate();
  s.pace_bitrate = pacer_.pace_bitrate();
  s.sent_bitrate = sent_rate_.Rate(std::max(now, now_));
  s.acked_bitrate = acked_rate_.Rate(std::max(now, now_));
  s.queued = streams.queued();
  s.media_qdelay = streams.media_qdelay(std::max(now, now_));
  s.foreign_blocks = history_.foreign_blocks();
  s.ecn_state = ecn.state();
  return s;
}

}  // namespace lidar::scream
