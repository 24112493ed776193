// SPDX-License-Identifier: LGPL-2.1-or-later
// What acknowledgements tell of the path: delays, marks, losses, rates and the link's capacity.
#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>

#include "src/scream/model/arrival_train.h"
#include "src/scream/model/busy_run.h"
#include "src/scream/model/classic_ecn.h"
#include "src/scream/model/cross_traffic.h"
#include "src/scream/model/ecn_monitor.h"
#include "src/scream/model/evidence.h"
#include "src/scream/model/flight.h"
#include "src/scream/model/l4s_alpha.h"
#include "src/scream/model/loss_context.h"
#include "src/scream/model/loss_rate.h"
#include "src/scream/model/marking_onset.h"
#include "src/scream/model/queue_delay.h"
#include "src/scream/model/rate_meter.h"
#include "src/scream/model/rtt.h"
#include "src/scream/model/sent_history.h"
#include "src/scream/parameters.h"
#include "src/scream/statistics.h"

namespace lidar::scream {

/// What the sender does while it measures.
struct SenderState {
  DataSize ref_wnd;
  Duration frame_period{0};
  Duration qdelay_target{0};
};

/// The estimators of one path. It decides nothing: the responses ask it.
class PathModel {
 public:
  explicit PathModel(const Parameters& parameters);

  /// `in_flight` includes the packet.
  void OnSent(Time now, DataSize size, Ecn ecn, DataSize in_flight);
  /// Comes before OnReport().
  void OnRoundTrip(Time now, const AckSummary& acks);
  void OnReport(Time now, const AckSummary& acks, const SenderState& sender);
  /// A gap is over: what was sent before `now` met it.
  void OnGapEnd(Time now, Duration s_rtt, double l4s_alpha);
  void EndRoundTrip(Time now);
  void OnTimer(Time now) { ecn_.OnTimer(now); }
  /// Another route: base delay, round trip, ECN, marks, losses and capacity are unknown again.
  void Reset(Time now);

  /// What was sent before some moment counts no more.
  Evidence& evidence() { return evidence_; }
  const Evidence& evidence() const { return evidence_; }
  const RoundTripTime& rtt() const { return rtt_; }
  const QueueDelay& queue_delay() const { return queue_delay_; }
  const L4sAlpha& l4s_alpha() const { return l4s_alpha_; }
  const LossRate& loss_rate() const { return loss_rate_; }
  const LossContext& loss_context() const { return loss_context_; }
  const ClassicEcn& classic_ecn() const { return classic_ecn_; }
  const CrossTraffic& cross_traffic() const { return cross_traffic_; }
  const EcnMonitor& ecn() const { return ecn_; }
  const BusyRun& busy_run() const { return busy_run_; }
  const ArrivalTrain& train() const { return train_; }
  /// The queue at which marking begins.
  Duration marking_onset() const { return marking_onset_.value(); }
  /// What the link carries, whatever the source sends: 0 while nothing is known.
  DataRate estimated_capacity() const { return std::max(train_capacity_, acked_peak_); }
  /// The same by the spacing of packets alone.
  DataRate train_capacity() const { return train_capacity_; }
  /// The link stood still, or nearly so, before a packet of the last report.
  bool hole_in_report() const { return hole_in_report_; }
  /// Within the last round trip.
  bool MarkedLately(Time now) const { return last_mark_ && now - *last_mark_ < rtt_.min(); }
  /// The packet that was acknowledged last came marked.
  bool newest_marked() const { return newest_marked_; }
  const MaxBytesInFlight& max_in_flight() const { return max_in_flight_; }
  DataRate sent_rate(Time now) const { return sent_rate_.Rate(now); }
  /// Over a round trip, or two frame periods where those are longer.
  DataRate acked_rate(Time now) const { return acked_rate_.Rate(now); }
  /// Over a second: read when packets arrive, a shorter average leaves out pauses between frames.
  DataRate long_acked_rate(Time now) const { return long_acked_rate_.Rate(now); }

  /// The path carries ECT(1), and its bottleneck has lately been one that marks it.
  bool L4sWorks(Time now) const;
  /// A packet that waited so long came out of a queue. Without marks a queue is no sign of
  /// congestion before the draft takes it for one.
  Duration BusyQdelay(Time now, Duration qdelay_target) const;
  /// The queue is longer than `qdelay`, and packets keep coming back out of it. Where marks work
  /// they have to be marked, too: delay alone may be a longer path.
  bool Queueing(Time now, Duration qdelay) const;
  /// Time between reports, on average.
  Duration report_gap() const { return report_gap_; }
  /// For how long what arrives has not been reported yet, and so still counts as in flight. 0
  /// unless reports are far apart, as round trips go.
  Duration UnreportedTime() const;
  /// The clocks drift apart: the draft sends at half the rate until then.
  Time half_rate_until() const { return half_rate_until_; }
  /// Round trips, delays, marks and rates; the rest of `statistics` is left alone.
  void Describe(Time now, Statistics* statistics) const;

 private:
  void MeasureDelays(Time now, const AckSummary& acks, const SenderState& sender);
  void CountMarksAndLosses(Time now, const AckSummary& acks, const SenderState& sender);
  void ObserveCapacity(Time now, const AckSummary& acks, Duration qdelay_target);
  void EstimateCapacity(Time now);
  void MeasureReports(Time now, const AckSummary& acks, DataSize ref_wnd);

  const Parameters& p_;
  RoundTripTime rtt_;
  QueueDelay queue_delay_{p_};
  L4sAlpha l4s_alpha_{p_};
  LossRate loss_rate_{p_};
  LossContext loss_context_;
  ClassicEcn classic_ecn_;
  CrossTraffic cross_traffic_;
  EcnMonitor ecn_{p_.ecn};
  BusyRun busy_run_;
  ArrivalTrain train_;
  MarkingOnset marking_onset_{p_.pacing_reserve};
  bool hole_in_report_ = false;
  DataRate train_capacity_;
  DataRate acked_peak_;  // of averages, since the last train
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
  std::uint64_t packets_ce_ = 0;
  std::uint64_t clock_resets_ = 0;
};

}  // namespace lidar::scream
