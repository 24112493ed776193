// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/scream/response/reference_window.h"

#include <cmath>

namespace lidar::scream {
namespace {

/// The slope of the reaction as a function of the distance to the inflection point, and the least
/// values of the scales.
constexpr double kInflectionSlope = 8;
constexpr double kInflectionMin = 0.1;
constexpr double kScaleMin = 0.25;
constexpr double kMostBackoff = 0.5;  // alpha / 2 if each packet is marked
constexpr double kJitterIncreaseMin = 0.1;
/// The number of round trips without congestion after which the window may far exceed the bytes in
/// flight.
constexpr double kLongUncongestedRtts = 100;

double Bytes(DataSize size) { return static_cast<double>(size.bytes()); }
double Ratio(Duration a, Duration b) { return Seconds(a) / Seconds(b); }

}  // namespace

ReferenceWindow::ReferenceWindow(const Parameters& parameters)
    : p_(parameters), ref_wnd_(Bytes(parameters.min_ref_wnd)) {}

void ReferenceWindow::Set(DataSize window) { ref_wnd_ = Bytes(std::max(window, p_.min_ref_wnd)); }

void ReferenceWindow::Start(DataRate rate, Duration s_rtt) {
  Restart(rate * s_rtt * p_.target_rate_divisor * ((p_.mss + p_.packet_overhead) / p_.mss));
}

void ReferenceWindow::Drop(Time now, DataSize window) {
  Restart(window);
  ref_wnd_i_ = ref_wnd_lowest_ = Bytes(window);
  ref_wnd_i_update_time_ = now;
  last_reaction_to_congestion_time_ = last_congestion_detected_time_ = last_drop_time_ = now;
}

void ReferenceWindow::Restart(DataSize window) {
  Set(window);
  ForgetSigns();
}

DataRate ReferenceWindow::TargetBitrate(Duration s_rtt, double queue_compensation) const {
  double scale = 1 - std::clamp(ref_wnd_ratio() - 0.1, 0.0, 0.2);
  scale *= p_.mss / (p_.mss + p_.packet_overhead);
  scale /= p_.target_rate_divisor + queue_compensation;
  return ref_wnd() / s_rtt * scale;
}

double ReferenceWindow::ref_wnd_ratio() const { return std::min(1.0, Bytes(p_.mss) / ref_wnd_); }

double ReferenceWindow::InflectionScale(double slope) const {
  const double scl = (ref_wnd_ - ref_wnd_i_) / ref_wnd_i_ * slope;
  return std::clamp(scl * scl, kInflectionMin, 1.0);
}

RateReason ReferenceWindow::Update(Time now, const CongestionSignals& signals) {
  loss_detected_ = loss_detected_ || signals.loss_detected;
  data_units_marked_ = data_units_marked_ || signals.data_units_marked;
  const double scl = InflectionScale(kInflectionSlope);
  const RateReason reason = Detect(now, signals);
  if (reason != RateReason::kIncrease) Reduce(now, reason, signals, scl);
  Increase(now, signals, scl);
  return reason;
}

RateReason ReferenceWindow::Detect(Time now, const CongestionSignals& s) {
  const bool isolated = p_.extensions.evidence && !s.loss_is_congestion;
  if (data_units_marked_ || (loss_detected_ && !isolated)) last_congestion_detected_time_ = now;
  if (now - last_reaction_to_congestion_time_ + s.earliness < std::min(p_.virtual_rtt, s.s_rtt))
    return RateReason::kIncrease;
  if (std::exchange(loss_detected_, false) && s.loss_is_congestion) return RateReason::kLoss;
  if (data_units_marked_) return RateReason::kCe;
  // A queue that shrinks causes a reaction, too, if the extension capacity is on.
  const bool falls = s.qdelay_avg_falls && !p_.extensions.capacity;
  if (s.qdelay_avg > p_.qdelay_target_lo / 2 && !falls) return RateReason::kDelay;
  return RateReason::kIncrease;
}

void ReferenceWindow::Reduce(Time now, RateReason reason, const CongestionSignals& s, double scl) {
  NoteInflectionPoint(now, s.s_rtt);
  if (reason == RateReason::kLoss)
    ref_wnd_ *= p_.beta_loss;
  else if (reason == RateReason::kDelay)
    ref_wnd_ *= 1 - VirtualBackoff(s);
  else if (s.is_l4s)
    ref_wnd_ *= 1 - L4sBackoff(now, s, scl);
  else
    ref_wnd_ *= p_.beta_ecn;
  ref_wnd_ = std::max(ref_wnd_, Bytes(p_.min_ref_wnd));
  ref_wnd_lowest_ = ref_wnd_;
  last_reaction_to_congestion_time_ = now;
  ForgetSigns();
}

/// Sets the inflection point to the window before a reduction. If the window has not grown since
/// the last reduction, keeps the inflection point, so that the reductions of one congestion do not
/// lower it step by step.
void ReferenceWindow::NoteInflectionPoint(Time now, Duration s_rtt) {
  const bool held = Ratio(now - ref_wnd_i_update_time_, s_rtt) > p_.ref_wnd_i_update_max_hold_rtts;
  if (ref_wnd_ <= ref_wnd_lowest_ * p_.ref_wnd_i_update_growth && !held) return;
  ref_wnd_i_ = ref_wnd_;
  ref_wnd_i_update_time_ = now;
}

double ReferenceWindow::L4sBackoff(Time now, const CongestionSignals& s, double scl) {
  double backoff = s.l4s_alpha / 2 * UndershootScale(s);
  backoff /= std::max(1.0, Ratio(s.s_rtt, p_.virtual_rtt));
  if (s.qdelay < p_.qdelay_target_lo / 4) {
    backoff *= std::max(s.boldness.backoff, scl);
    backoff *= std::max(kScaleMin, s.ref_wnd_delay_scale);
    backoff = std::min(backoff, kMostBackoff);
  }
  const double rtts =
      Ratio(now - last_reaction_to_congestion_time_, std::max(p_.virtual_rtt, s.s_rtt));
  if (rtts > kLongUncongestedRtts) ref_wnd_ = std::min(ref_wnd_, Bytes(s.max_bytes_in_flight_prev));
  return backoff;
}

double ReferenceWindow::VirtualBackoff(const CongestionSignals& s) const {
  const double half = Seconds(p_.qdelay_target_lo) / 2;
  const double alpha = std::clamp((Seconds(s.qdelay_avg) - half) / half, 0.0, 1.0);
  return alpha / 2 / std::max(1.0, Ratio(s.s_rtt, p_.virtual_rtt)) * UndershootScale(s);
}

/// See the draft's section "Reference window undershoot at congestion".
double ReferenceWindow::UndershootScale(const CongestionSignals& s) const {
  if (!p_.undershoot_remedy) return 1;
  const bool low = s.target_bitrate < s.acked_bitrate * p_.acked_bitrate_margin;
  return low ? p_.backoff_scale_low_target_rate : 1;
}

/// Extension capacity: returns the fast growth. It is slower near the measured capacity or, if no
/// capacity is measured, near the inflection point.
double ReferenceWindow::FastIncrement(const CongestionSignals& s, double scl) const {
  const auto capacity = Bytes(s.capacity_window);
  double scale = ref_wnd_ > ref_wnd_i_ ? InflectionScale(p_.fast_increase_slope) : scl;
  if (capacity > 0) {
    const double distance = (ref_wnd_ - capacity) / capacity * p_.fast_increase_slope;
    scale = std::clamp(distance * distance, kInflectionMin, 1.0);
  }
  return s.fast_growth * scale * Bytes(s.bytes_newly_acked);
}

void ReferenceWindow::Increase(Time now, const CongestionSignals& s, double scl) {
  const Duration rtt = std::max(p_.virtual_rtt, s.s_rtt);
  const double post_congestion_scale = std::clamp(
      Ratio(now - last_congestion_detected_time_, rtt) / p_.post_congestion_delay_rtt, 0.0, 1.0);
  double increment = Bytes(s.bytes_newly_acked - s.bytes_newly_acked_ce) * ref_wnd_ratio();
  increment *= std::min(1.0, Ratio(s.s_rtt, p_.virtual_rtt));
  increment *= std::max(s.boldness.growth, scl);
  increment *= std::max(kJitterIncreaseMin, s.ref_wnd_delay_scale);
  const double multiplicative = p_.mul_increase_factor * ref_wnd_ / Bytes(p_.mss);
  increment *= 1 + multiplicative * post_congestion_scale * scl;
  increment = std::max(increment, FastIncrement(s, scl));

  const DataSize max_allowed =
      p_.mss +
      std::max(s.max_bytes_in_flight, s.max_bytes_in_flight_prev) * p_.bytes_in_flight_head_room;
  const double next = ref_wnd_ + increment;
  if (increment > 0 && next <= Bytes(max_allowed) && s.target_bitrate < s.target_bitrate_max)
    ref_wnd_ = next;
  ref_wnd_ = std::max(ref_wnd_, Bytes(p_.min_ref_wnd));
}

}  // namespace lidar::scream
