// SPDX-License-Identifier: LGPL-2.1-or-later
// Draft section "Reference Window Update": reduction, increase, and limits.
#pragma once
#include <algorithm>
#include <utility>

#include "src/scream/parameters.h"
#include "src/scream/statistics.h"

namespace lidar::scream {

/// Extension company: the least growth and reaction near the inflection point, relative to their
/// full values. A flow whose `backoff` is above 1 gives way faster than a flow of the draft, but
/// never by more than half of its window.
struct Boldness {
  double growth = 0.25;
  double backoff = 0.25;
  /// The mean rate at which packets leave, divided by ref_wnd / RTT. Without other flows it is
  /// slightly above 1, so that the sender has sent a frame before the next frame comes.
  double pace = 1.005;
};

/// The signs of congestion in a report.
struct CongestionSignals {
  bool loss_detected = false;
  bool loss_is_congestion = true;
  bool data_units_marked = false;
  double l4s_alpha = 0;
  bool is_l4s = true;  ///< marks are L4S marks, not classic ECN
  Duration qdelay{0};
  Duration qdelay_avg{0};
  bool qdelay_avg_falls = false;
  double ref_wnd_delay_scale = 1;
  Boldness boldness;
  /// Extension capacity: the time by which a reaction may come before the end of the round trip.
  /// The next report may come long after the end of the round trip, which would delay the reaction.
  Duration earliness{0};
  Duration s_rtt{0};
  DataSize max_bytes_in_flight;
  DataSize max_bytes_in_flight_prev;
  /// The window that fills the measured capacity, or 0 if the capacity is unknown.
  DataSize capacity_window;
  DataSize bytes_newly_acked;
  DataSize bytes_newly_acked_ce;
  DataRate target_bitrate;
  DataRate target_bitrate_max;
  DataRate acked_bitrate;
  double fast_growth = 0;  ///< growth as a fraction of the acknowledged bytes
};

class ReferenceWindow {
 public:
  explicit ReferenceWindow(const Parameters& parameters);

  /// Updates the window after a report. Reduces it at most once every min(VIRTUAL_RTT, s_rtt), then
  /// increases it. Returns the reason of the reduction, or kIncrease.
  RateReason Update(Time now, const CongestionSignals& signals);
  /// Sets the window independently of the draft's rules, but never below MIN_REF_WND.
  void Set(DataSize window);
  /// Sets the window whose target is `rate`. The draft does not define the window at the start.
  /// Drops earlier marks and losses to which there was no reaction yet.
  void Start(DataRate rate, Duration s_rtt);
  /// Call it when the link's capacity has fallen. Sets `window`, which fills the link. The draft's
  /// own reaction then waits.
  void Drop(Time now, DataSize window);
  /// Sets the window after a gap or an outage. Drops marks and losses to which there was no
  /// reaction yet, because they come from that gap or outage.
  void Restart(DataSize window);
  void Limit(DataSize max) { Set(std::min(max, ref_wnd())); }

  DataSize ref_wnd() const { return DataSize::Bytes(static_cast<std::int64_t>(ref_wnd_)); }
  DataSize ref_wnd_i() const { return DataSize::Bytes(static_cast<std::int64_t>(ref_wnd_i_)); }
  /// Returns the target bitrate by the draft's section "Media Rate Control", without the limits of
  /// that section. `queue_compensation` is rate_adjust_factor + frame_size_dev.
  DataRate TargetBitrate(Duration s_rtt, double queue_compensation) const;
  Time last_reaction_to_congestion_time() const { return last_reaction_to_congestion_time_; }
  Time last_congestion_detected_time() const { return last_congestion_detected_time_; }
  Time last_drop_time() const { return last_drop_time_; }

 private:
  /// Drops marks and losses to which there was no reaction yet.
  void ForgetSigns() { loss_detected_ = data_units_marked_ = false; }
  double ref_wnd_ratio() const;
  double InflectionScale(double slope) const;
  double FastIncrement(const CongestionSignals& s, double scl) const;
  RateReason Detect(Time now, const CongestionSignals& s);
  void Reduce(Time now, RateReason reason, const CongestionSignals& s, double scl);
  double L4sBackoff(Time now, const CongestionSignals& s, double scl);
  double VirtualBackoff(const CongestionSignals& s) const;
  double UndershootScale(const CongestionSignals& s) const;
  void NoteInflectionPoint(Time now, Duration s_rtt);
  void Increase(Time now, const CongestionSignals& s, double scl);

  const Parameters& p_;
  double ref_wnd_;
  double ref_wnd_i_ = 1;
  double ref_wnd_lowest_ = 0;  // ref_wnd_ after the last reduction
  Time ref_wnd_i_update_time_{};
  bool loss_detected_ = false;      // since the last reaction
  bool data_units_marked_ = false;  // since the last reaction
  Time last_congestion_detected_time_{};
  Time last_reaction_to_congestion_time_{};
  Time last_drop_time_{};
};

}  // namespace lidar::scream
