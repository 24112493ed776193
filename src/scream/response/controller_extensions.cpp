// SPDX-License-Identifier: LGPL-2.1-or-later
// The part of a controller that goes beyond the draft: drops, bounds, pacing reserve, outages.
#include "src/scream/controller_impl.h"

namespace lidar::scream {
namespace {

/// Silence of the receiver, beyond what round trips explain, that is taken for an outage.
constexpr Duration kOutage = 200ms;
constexpr double kOutageRestart = 0.5;
constexpr double kTimeoutBackoff = 0.5;
/// So long after a mark the next sign of congestion is expected to be one too.
constexpr Duration kMarksExpected = 30s;
/// Reports that are no further apart than this part of a round trip need no allowance; others one
/// of this at most.
constexpr int kCloseReports = 5;
constexpr Duration kLongestGap = 100ms;
/// Packets in a row behind a queue that are no accident.
constexpr int kQueueingPackets = 3;

}  // namespace

DataSize Controller::Impl::MaxInFlight() const {
  double overhead = p.ref_wnd_overhead_min + (p.ref_wnd_overhead_max - p.ref_wnd_overhead_min) *
                                                 queue_delay_.ref_wnd_delay_scale();
  if (p.extensions.bounded_flight) {
    if (L4sWorks()) overhead = std::min(overhead, p.open_overhead);
    if (Queueing(2 * BusyQdelay())) overhead = p.bounded_overhead;
    overhead *= 1 + Seconds(UnreportedTime()) / Seconds(rtt_.smoothed());
  }
  return window_.ref_wnd() * overhead;
}

/// What arrived between reports that are far apart, as round trips go, still counts as in flight.
Duration Controller::Impl::UnreportedTime() const {
  return std::max(Duration{0}, report_gap_ - rtt_.smoothed() / kCloseReports);
}

/// Weighted by what the report acknowledges: a pause of the source is no gap.
void Controller::Impl::MeasureReports(Time now, const AckSummary& summary) {
  const Duration gap = std::min<Duration>(now - std::exchange(last_summary_, now), kLongestGap);
  const double weight = std::min(1.0, summary.bytes_newly_acked / window_.ref_wnd());
  report_gap_ += FromSeconds(Seconds(gap - report_gap_) * weight);
}

/// The path carries ECT(1), and its bottleneck has lately been one that marks it.
bool Controller::Impl::L4sWorks() const {
  return p.ecn == Ecn::kEct1 && ecn.state() == EcnState::kCapable && last_mark_ &&
         now_ - *last_mark_ < kMarksExpected;
}

/// Without marks a queue is no sign of congestion before the draft takes it for one.
Duration Controller::Impl::BusyQdelay() const {
  return L4sWorks()
             ? p.busy_qdelay
             : FromSeconds(Seconds(competing_flows_.qdelay_target()) * p.busy_qdelay_unmarked);
}

/// The queue is long and packets keep coming back out of it; where marks work, marked: delay alone
/// may be a longer path.
bool Controller::Impl::Queueing(Duration qdelay) const {
  const bool believed = !L4sWorks() || 3 * busy_run_.marked() >= busy_run_.packets();
  return busy_run_.packets() >= kQueueingPackets && believed && queue_delay_.qdelay() > qdelay;
}

void Controller::Impl::ObserveCapacity(const AckSummary& summary) {
  for (const AckedPacket& packet : summary.acked) {
    if (!packet.arrival) {  // a hole in what is known of the link
      busy_run_.Reset();
      continue;
    }
    const bool marked = packet.arrived_ecn == Ecn::kCe;
    const Duration qdelay = *packet.arrival - packet.sent - queue_delay_.base();
    busy_run_.Add({*packet.arrival, packet.size, marked || qdelay >= BusyQdelay(), marked});
  }
}

/// Beyond the draft: a link that turns out to carry much less than the target gets no more than
/// that from the next packet on.
bool Controller::Impl::RespondToDrop(Time now, const CongestionSignals& signals) {
  const auto capacity = busy_run_.capacity();
  if (!p.extensions.drop_response || !capacity || !Queueing(BusyQdelay())) return false;
  const Duration round = std::min(p.virtual_rtt, signals.s_rtt);
  if (now - last_drop_ < round) return false;
  // While a frame of another flow takes turns with ours, we see but our share; few marks may be
  // those of a link that is well used; and what was just answered may be enough.
  const bool sure = busy_run_.span() >= std::min(streams.frame_period(), p.virtual_rtt) &&
                    (!L4sWorks() || 2 * busy_run_.marked() >= busy_run_.packets()) &&
                    now - window_.last_reaction_to_congestion_time() >= round;
  const DataRate affordable = *capacity * (sure ? p.drop_threshold : p.drop_threshold_unsure);
  if (affordable > streams.target_bitrate()) return false;
  const DataSize window = *capacity * rtt_.min() * p.target_rate_divisor;
  if (window > window_.ref_wnd()) return false;
  window_.SetInflection(window);
  window_.Set(window * p.drop_beta);
  window_.NoteReaction(now);
  last_drop_ = now;
  if (p.extensions.answered_signals) marks_answered_ = loss_answered_ = now;
  fast_increase_.OnCongestion(now);
  ++counters_.capacity_drops;
  counters_.reason = RateReason::kDrop;
  return true;
}

/// Marks of a frame source come once a frame.
Duration Controller::Impl::Round() const {
  return std::max({rtt_.smoothed(), p.virtual_rtt, streams.frame_period()});
}

double Controller::Impl::PacingHeadroom() const {
  if (!p.extensions.adaptive_pacing) return p.packet_pacing_headroom;
  const double reserve = std::clamp(Seconds(p.pacing_reserve) / Seconds(streams.frame_period()),
                                    p.min_pacing_reserve, p.max_pacing_reserve);
  return 1 / (1 - reserve);
}

Duration Controller::Impl::FeedbackTimeout() const {
  return 2 * rtt_.smoothed() + std::max<Duration>(kOutage, 2 * streams.frame_period());
}

/// Beyond the draft: without feedback the window halves again and again.
void Controller::Impl::OnFeedbackTimeout(Time now) {
  last_timeout_ = now;
  ++counters_.feedback_timeouts;
  counters_.reason = RateReason::kTimeout;
  if (!window_before_outage_) window_before_outage_ = window_.ref_wnd();
  window_.Set(window_.ref_wnd() * kTimeoutBackoff);
}

void Controller::Impl::EndOutage(Time now) {
  window_.Set(std::max(window_.ref_wnd(), *window_before_outage_ * kOutageRestart));
  // What the path held back comes first: marks behind it are answered with the restart.
  marks_answered_ = loss_answered_ = now + rtt_.smoothed();
  window_before_outage_.reset();
  fast_increase_.Restart();
}

}  // namespace lidar::scream
