// SPDX-License-Identifier: LGPL-2.1-or-later
// The state of a controller: one object for each section of the draft, sequenced by its events.
#pragma once
#include <algorithm>

#include "src/scream/controller.h"
#include "src/scream/media_rate.h"
#include "src/scream/model/busy_run.h"
#include "src/scream/model/ecn_monitor.h"
#include "src/scream/model/flight.h"
#include "src/scream/model/l4s_alpha.h"
#include "src/scream/model/loss_rate.h"
#include "src/scream/model/queue_delay.h"
#include "src/scream/model/rtt.h"
#include "src/scream/model/sent_history.h"
#include "src/scream/pacer.h"
#include "src/scream/response/competing_flows.h"
#include "src/scream/response/fast_increase.h"
#include "src/scream/response/reference_window.h"
#include "src/scream/steady_time.h"
#include "src/scream/streams.h"

namespace lidar::scream {

class Controller::Impl {
 public:
  explicit Impl(const Parameters& parameters);

  StreamId AddStream(const StreamConfig& config);
  void ConfigureStream(StreamId id, const StreamConfig& config);
  void OnQueued(Time now, StreamId id, const QueuedPacket& packet);
  void OnSent(Time now, StreamId id, const SentPacket& packet);
  void OnDropped(Time now, StreamId id, std::size_t packets);
  FeedbackResult OnFeedback(Time now, const CongestionFeedback& feedback);
  void OnTimer(Time now);
  void OnRouteChange(Time now);
  std::optional<SendDecision> NextSend(Time now) const;
  Time NextTimer() const;
  Statistics GetStatistics(Time now) const;

  const Parameters p;
  Streams streams{p};
  EcnMonitor ecn{p.ecn};
  SteadyTime clock;  // of the caller; all times within are its steady ones

 private:
  void UpdateTarget(Time now);
  Time Advance(Time now);
  void OnSummary(Time now, const AckSummary& summary);
  void MeasurePath(Time now, const AckSummary& summary);
  void CountAcks(Time now, const AckSummary& summary);
  CongestionSignals Signals(const AckSummary& summary);
  void StartWindow();
  void React(Time now, const CongestionSignals& signals);
  void LimitWindowAtMaxBitrate();
  void ObserveCapacity(const AckSummary& summary);
  bool RespondToDrop(Time now, const CongestionSignals& signals);
  bool L4sWorks() const;
  Duration BusyQdelay() const;
  bool Queueing(Duration qdelay) const;
  double PacingHeadroom() const;
  Duration Round() const;
  void OnFeedbackTimeout(Time now);
  void EndOutage(Time now);
  Duration FeedbackTimeout() const;
  bool SourceLimited() const;
  DataRate TargetOf(Time now) const;
  DataSize MaxInFlight() const;
  void MeasureReports(Time now, const AckSummary& summary);
  Duration UnreportedTime() const;

  Time now_{};
  SentHistory history_;
  RoundTripTime rtt_;
  QueueDelay queue_delay_{p};
  L4sAlpha l4s_alpha_{p};
  LossRate loss_rate_{p};
  CompetingFlows competing_flows_{p};
  ReferenceWindow window_{p};
  FastIncrease fast_increase_{p};
  BusyRun busy_run_;
  Pacer pacer_{p};
  MaxBytesInFlight max_in_flight_;
  mutable RateMeter sent_rate_{1s};
  mutable RateMeter acked_rate_{100ms};
  bool started_ = false;  // an acknowledgement has come
  Time last_feedback_{};
  Time last_sent_{};
  Time last_housekeeping_{};
  Time last_drop_{};
  Time last_summary_{};
  Duration report_gap_{0};
  Time last_timeout_{};
  std::optional<DataSize> window_before_outage_;
  std::optional<Time> last_mark_;
  Time loss_answered_{};    // losses of packets sent before it have had their reaction
  Time marks_answered_{};   // as have such marks
  Time half_rate_until_{};  // clock-drift remedy
  Statistics counters_;
};

}  // namespace lidar::scream
