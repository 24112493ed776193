// SPDX-License-Identifier: LGPL-2.1-or-later
// The path as acknowledgements show it: delays, marks, losses, rates and the link's capacity.
#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>

#include "src/base/rate_meter.h"
#include "src/scream/model/busy_run.h"
#include "src/scream/model/classic_ecn.h"
#include "src/scream/model/cross_traffic.h"
#include "src/scream/model/ecn_monitor.h"
#include "src/scream/model/evidence.h"
#include "src/scream/model/flight.h"
#include "src/scream/model/l4s_alpha.h"
#include "src/scream/model/loss_context.h"
#include "src/scream/model/queue_delay.h"
#include "src/scream/model/rtt.h"
#include "src/scream/model/sent_history.h"
#include "src/scream/parameters.h"
#include "src/scream/statistics.h"

namespace lidar::scream {

/// The sender's state during a measurement.
struct SenderState {
  DataSize ref_wnd;
  Duration frame_period{0};
};

/// The estimators of one path. They only measure, and the classes in `response/` decide how to
/// react.
class PathModel {
 public:
  explicit PathModel(const Parameters& parameters) : p_(parameters) {}

  /// Call it for each packet that is sent. `in_flight` includes the packet.
  void OnSent(Time now, DataSize size, Ecn ecn, DataSize in_flight);
  /// Call it before OnReport().
  void OnRoundTrip(Time now, const AckSummary& acks) {
    if (acks.rtt && evidence_.Counts(acks)) rtt_.Add(now, *acks.rtt);
  }
  void OnReport(Time now, const AckSummary& acks, const SenderState& sender);
  /// Call it after a gap. Packets that were sent before `now` have met the gap and do not count.
  void OnGapEnd(Time now, Duration s_rtt, double l4s_alpha);
  void EndRoundTrip(Time now) {
    max_in_flight_.Update(now, std::max(p_.virtual_rtt, rtt_.smoothed()));
  }
  void OnTimer(Time now) { ecn_.OnTimer(now); }
  /// Call it after a change of the route. Resets the base delay, round trip, ECN, marks, losses and
  /// capacity.
  void Reset(Time now);

  Evidence& evidence() { return evidence_; }
  const Evidence& evidence() const { return evidence_; }
  const RoundTripTime& rtt() const { return rtt_; }
  const QueueDelay& queue_delay() const { return queue_delay_; }
  const L4sAlpha& l4s_alpha() const { return l4s_alpha_; }
  /// Returns the loss rate, averaged as in the draft's section "Link layer losses and rate
  /// policers".
  double loss_rate() const { return loss_rate_; }
  const LossContext& loss_context() const { return loss_context_; }
  const ClassicEcn& classic_ecn() const { return classic_ecn_; }
  const CrossTraffic& cross_traffic() const { return cross_traffic_; }
  const EcnMonitor& ecn() const { return ecn_; }
  const BusyRun& busy_run() const { return busy_run_; }
  /// Returns the queue delay at which the bottleneck starts to mark. It is a low quantile of the
  /// queue delays of marked packets. Its resolution is about a millisecond, because arrival times
  /// in reports are coarse and the base delay is the minimum of coarse delays.
  Duration marking_onset() const { return marking_onset_; }
  /// Returns the link's capacity, measured by the spacing of packets that waited in its queue, or 0
  /// if the capacity is unknown.
  DataRate measured_capacity() const { return measured_capacity_; }
  // The results of the last report. A mark or loss is new if the sender has not reacted to it yet.
  bool new_mark() const { return new_mark_; }
  bool new_loss() const { return new_loss_; }
  /// Returns true if the link carried almost nothing for a while before it carried a packet of the
  /// last report.
  bool hole_in_report() const { return hole_in_report_; }
  /// Returns true if a mark was reported within the last round trip.
  bool MarkedLately(Time now) const { return last_mark_ && now - *last_mark_ < rtt_.min(); }
  /// Returns true if the newest acknowledged packet was marked.
  bool newest_marked() const { return newest_marked_; }
  const MaxBytesInFlight& max_in_flight() const { return max_in_flight_; }
  /// Returns the acknowledged rate, averaged over a round trip or, if that is longer, over two
  /// frame periods.
  DataRate acked_rate(Time now) const { return acked_rate_.Rate(now); }
  /// Returns the acknowledged rate, averaged over a second. The rate is read when packets arrive,
  /// so that a shorter average would ignore the pauses between frames.
  DataRate long_acked_rate(Time now) const { return long_acked_rate_.Rate(now); }

  /// Returns true if the path carries ECT(1) and its bottleneck has recently marked it.
  bool L4sWorks(Time now) const;
  /// Returns the queueing delay of a packet that shows a busy link. Without marks it is close to
  /// the delay that the draft counts as congestion.
  Duration BusyQdelay(Time now) const;
  /// Returns true if the queueing delay exceeds `qdelay` and the latest packets all waited in a
  /// queue.
  bool Queueing(Duration qdelay) const;
  /// Returns the least time between reactions: min(VIRTUAL_RTT, s_rtt).
  Duration ReactionInterval() const { return std::min(p_.virtual_rtt, rtt_.smoothed()); }
  /// Returns the round trip, but at least VIRTUAL_RTT and a frame period. The frame period matters
  /// because the marks of a source of frames arrive once per frame.
  Duration Round(Duration frame_period) const {
    return std::max({rtt_.smoothed(), p_.virtual_rtt, frame_period});
  }
  Duration report_gap() const { return report_gap_; }
  /// Returns for how long packets that have arrived still count as in flight, because no report has
  /// acknowledged them. The time is 0 unless reports are far apart relative to the round trip.
  Duration UnreportedTime() const;
  /// Returns the time until which the draft sends at half the rate, because the clocks drift apart.
  Time half_rate_until() const { return half_rate_until_; }
  /// Sets the fields of `statistics` for round trips, delays, marks and rates. Does not change the
  /// other fields.
  void Describe(Time now, Statistics* statistics) const;

 private:
  void MeasureDelays(Time now, const AckSummary& acks);
  void CountMarksAndLosses(Time now, const AckSummary& acks, const SenderState& sender);
  void AverageLoss(bool lost, DataSize ref_wnd);
  void ObserveCapacity(Time now, const AckSummary& acks);
  void ObserveMark(Duration qdelay);
  void EstimateCapacity(Time now);
  void MeasureReports(Time now, const AckSummary& acks, DataSize ref_wnd);

  const Parameters& p_;
  RoundTripTime rtt_;
  QueueDelay queue_delay_{p_};
  L4sAlpha l4s_alpha_{p_};
  double loss_rate_ = 0;
  LossContext loss_context_;
  ClassicEcn classic_ecn_;
  CrossTraffic cross_traffic_;
  EcnMonitor ecn_{p_.ecn};
  BusyRun busy_run_;
  Duration marking_onset_ = p_.pacing_reserve;
  bool new_mark_ = false, new_loss_ = false;
  bool hole_in_report_ = false;
  DataRate measured_capacity_;
  DataRate acked_peak_;  // highest average since the last measurement
  Evidence evidence_;
  MaxBytesInFlight max_in_flight_;
  mutable RateMeter sent_rate_{1s};
  mutable RateMeter acked_rate_{100ms};
  mutable RateMeter long_acked_rate_{1s};
  std::optional<Time> last_mark_;
  bool newest_marked_ = false;
  Time last_loss_{};
  Time last_report_{};
  Duration report_gap_{0};
  Time half_rate_until_{};
  std::uint64_t clock_resets_ = 0;
};

}  // namespace lidar::scream
