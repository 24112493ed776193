// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/scream/model/path_model.h"

#include <algorithm>
#include <utility>

namespace lidar::scream {
namespace {

/// Marks are the expected sign of congestion for this time after a mark.
constexpr Duration kMarksExpected = 30s;
/// A full queue is expected to overflow again within this time after a loss.
constexpr Duration kLossesExpected = 10s;
/// Unreported packets do not matter if the time between reports is less than a round trip divided
/// by this number.
constexpr int kCloseReports = 5;
/// A longer time between reports counts as this time.
constexpr Duration kLongestInterval = 100ms;
constexpr double kCapacityGain = 0.25;
constexpr double kOnsetFall = 1.0 / 32;
constexpr double kOnsetRise = 1.0 / 128;
/// If this many packets in a row met a queue, this cannot be chance.
constexpr int kQueueingPackets = 3;
/// The least duration of the clock-drift remedy, which usually lasts five round trips.
constexpr Duration kShortestHalfRate = 200ms;

}  // namespace

void PathModel::OnSent(Time now, DataSize size, Ecn ecn, DataSize in_flight) {
  max_in_flight_.Add(in_flight);
  sent_rate_.Add(now, size);
  ecn_.OnSent(now, ecn);
}

void PathModel::OnGapEnd(Time now, Duration s_rtt, double l4s_alpha) {
  evidence_.BeginAt(now);
  queue_delay_.ForgetQueue();
  busy_run_.Reset();
  rtt_.Restore(std::max(s_rtt, rtt_.min()));
  l4s_alpha_.Restore(l4s_alpha);
}

void PathModel::OnReport(Time now, const AckSummary& acks, const SenderState& sender) {
  MeasureDelays(now, acks);
  CountMarksAndLosses(now, acks, sender);
  ObserveCapacity(now, acks);
  MeasureReports(now, acks, sender.ref_wnd);
}

void PathModel::Reset(Time now) {
  evidence_.BeginAt(now);
  queue_delay_.Reset();
  rtt_.Reset();
  busy_run_.Reset();
  classic_ecn_ = ClassicEcn();
  cross_traffic_ = CrossTraffic();
  loss_context_ = LossContext();
  loss_rate_ = 0;
  measured_capacity_ = acked_peak_ = DataRate();
  report_gap_ = Duration{0};
  half_rate_until_ = Time{};
  ecn_.Reset();
  last_mark_.reset();
  newest_marked_ = false;
  l4s_alpha_.Reset();
  marking_onset_ = p_.pacing_reserve;
}

void PathModel::MeasureDelays(Time now, const AckSummary& acks) {
  const Duration excess = rtt_.last() - rtt_.min();
  const bool recent = p_.extensions.evidence && L4sWorks(now);
  for (const AckedPacket& packet : acks.acked) {
    if (!packet.arrival) continue;
    if (queue_delay_.Add(now, {packet.sent, *packet.arrival, excess, now - acks.report}, recent))
      continue;
    ++clock_resets_;
    busy_run_.EndRun();
  }
  if (evidence_.Counts(acks) && queue_delay_.Update(now, rtt_.smoothed())) {
    ++clock_resets_;
    half_rate_until_ = now + std::max(5 * rtt_.smoothed(), kShortestHalfRate);
  }
}

void PathModel::CountMarksAndLosses(Time now, const AckSummary& acks, const SenderState& sender) {
  int marked = 0;
  const auto count_mark = [&](Time sent) {
    if (evidence_.MarkCounts(sent)) ++marked;
    if (evidence_.Counts(sent)) last_mark_ = now;
  };
  for (const Time sent : acks.late_ce) count_mark(sent);
  acked_rate_.set_window(std::max(rtt_.smoothed(), 2 * sender.frame_period));
  for (const AckedPacket& packet : acks.acked) {
    newest_marked_ = packet.arrived_ecn == Ecn::kCe;
    if (newest_marked_) count_mark(packet.sent);
    if (evidence_.Counts(packet.sent)) ecn_.OnAcked(packet.ecn, packet.arrived_ecn);
    AverageLoss(false, sender.ref_wnd);
    acked_rate_.Add(now, packet.size);
    long_acked_rate_.Add(now, packet.size);
  }
  new_mark_ = marked > 0;
  new_loss_ = false;
  for (const SentRecord& packet : acks.lost) {
    new_loss_ = new_loss_ || evidence_.LossCounts(packet.sent);
    AverageLoss(true, sender.ref_wnd);
  }
  if (!acks.lost.empty()) last_loss_ = now;
  l4s_alpha_.Update(now, static_cast<int>(acks.acked.size()), marked, rtt_.smoothed(),
                    Round(sender.frame_period));
}

void PathModel::AverageLoss(bool lost, DataSize ref_wnd) {
  const double alpha = std::min(p_.loss_rate_threshold / 4, p_.mss / ref_wnd / 2);
  loss_rate_ = (1 - alpha) * loss_rate_ + (lost ? alpha : 0);
}

void PathModel::ObserveMark(Duration qdelay) {
  const double gain = qdelay < marking_onset_ ? kOnsetFall : kOnsetRise;
  marking_onset_ += FromSeconds(Seconds(qdelay - marking_onset_) * gain);
}

void PathModel::ObserveCapacity(Time now, const AckSummary& acks) {
  hole_in_report_ = false;
  const bool lossy = loss_context_.AtFullQueue() && now - last_loss_ < kLossesExpected;
  const bool congested = MarkedLately(now) || lossy;
  cross_traffic_.BeginReport();
  for (const AckedPacket& packet : acks.acked) {
    if (!packet.arrival) {  // the spacing around it is unknown
      busy_run_.EndRun();
      continue;
    }
    const bool marked = packet.arrived_ecn == Ecn::kCe;
    const Duration qdelay = *packet.arrival - packet.sent - queue_delay_.base();
    const bool busy = marked || qdelay >= BusyQdelay(now);
    loss_context_.OnAcked(packet.sent, qdelay);
    if (evidence_.Counts(packet.sent)) {
      classic_ecn_.OnPacket(now, qdelay, marked);
      if (marked) ObserveMark(qdelay);
      cross_traffic_.Add({packet.sent, *packet.arrival, packet.size}, qdelay, congested);
    }
    if (busy_run_.Add({packet.sent, *packet.arrival, packet.size, qdelay, busy, marked}))
      hole_in_report_ = true;
  }
  for (const SentRecord& packet : acks.lost) loss_context_.OnLost(packet.sent);
  EstimateCapacity(now);
}

/// Updates the estimates of the capacity. Packets that come out of a queue show the capacity,
/// whatever the rate of the source is. Without them, the acknowledged rate is a lower bound of the
/// capacity.
void PathModel::EstimateCapacity(Time now) {
  acked_peak_ = std::max(acked_peak_, acked_rate_.Rate(now));
  const auto rate = busy_run_.latest_capacity();
  if (!rate) return;
  const double gain = measured_capacity_ > DataRate() ? kCapacityGain : 1;
  measured_capacity_ = measured_capacity_ * (1 - gain) + *rate * gain;
  acked_peak_ = DataRate();
}

/// Averages the time between reports. The weight of a report is what it acknowledges, because a
/// pause of the source must not count as a gap between reports.
void PathModel::MeasureReports(Time now, const AckSummary& acks, DataSize ref_wnd) {
  const Duration gap = std::min(now - std::exchange(last_report_, now), kLongestInterval);
  const double weight = std::min(1.0, acks.bytes_newly_acked / ref_wnd);
  report_gap_ += FromSeconds(Seconds(gap - report_gap_) * weight);
}

bool PathModel::L4sWorks(Time now) const {
  return p_.ecn == Ecn::kEct1 && ecn_.state() == EcnState::kCapable && last_mark_ &&
         now - *last_mark_ < kMarksExpected;
}

Duration PathModel::BusyQdelay(Time now) const {
  return L4sWorks(now) ? p_.busy_qdelay
                       : FromSeconds(Seconds(p_.qdelay_target_lo) * p_.busy_qdelay_unmarked);
}

bool PathModel::Queueing(Duration qdelay) const {
  return busy_run_.packets() >= kQueueingPackets && queue_delay_.qdelay() > qdelay;
}

Duration PathModel::UnreportedTime() const {
  return std::max(Duration{0}, report_gap_ - rtt_.smoothed() / kCloseReports);
}

void PathModel::Describe(Time now, Statistics* s) const {
  s->s_rtt = rtt_.known() ? rtt_.smoothed() : Duration{0};
  s->min_rtt = rtt_.known() ? rtt_.min() : Duration{0};
  s->qdelay = queue_delay_.qdelay();
  s->qdelay_avg = queue_delay_.qdelay_avg();
  s->l4s_alpha = l4s_alpha_.value();
  s->ref_wnd_delay_scale = queue_delay_.ref_wnd_delay_scale();
  s->loss_rate = loss_rate_;
  if (cross_traffic_.found())
    s->cross_traffic = std::clamp(cross_traffic_.share().value_or(0), 0.0, 1.0);
  s->sent_bitrate = sent_rate_.Rate(now);
  s->acked_bitrate = acked_rate_.Rate(now);
  s->estimated_capacity = std::max(measured_capacity_, acked_peak_);
  s->clock_resets = clock_resets_;
  s->ecn_state = ecn_.state();
}

}  // namespace lidar::scream
