// SPDX-License-Identifier: LGPL-2.1-or-later
// Draft section "Detecting Increased Queue Delay", with its jitter scale and clock-drift remedy.
#pragma once
#include <deque>
#include <optional>

#include "src/scream/model/recent_min.h"
#include "src/scream/parameters.h"

namespace lidar::scream {

/// An acknowledged packet.
struct DelaySample {
  Time sent{};
  Time arrival{};  ///< on the receiver's clock
  /// Round trip above its minimum, an upper bound for a queue's delay.
  Duration rtt_excess{0};
  /// Time from the report, on the receiver's clock, to its arrival on ours.
  Duration way_back{0};
};

/// One-way delay above its base (RFC 6817). The clocks share no epoch, so only differences count.
class QueueDelay {
 public:
  explicit QueueDelay(const Parameters& parameters) : p_(parameters) {}

  /// Returns false if the clocks jumped relative to each other; the base is then taken anew. With
  /// `short_history` the base is the minimum of the last half minute.
  bool Add(Time now, const DelaySample& sample, bool short_history = false);
  /// Updates the averages after the packets of a report, at most once every min(VIRTUAL_RTT,
  /// s_rtt). Returns true if the clock-drift remedy takes a new base.
  bool Update(Time now, Duration s_rtt);
  void ForgetQueue() { qdelay_avg_ = Duration{0}; }
  void Reset();

  Duration base() const { return base_.value_or(Duration{0}); }
  Duration qdelay() const { return qdelay_; }
  Duration qdelay_avg() const { return qdelay_avg_; }
  /// Returns true if qdelay_avg fell at its last update.
  bool qdelay_avg_falls() const { return qdelay_avg_falls_; }
  /// 1: no jitter, 0: much jitter. Always 1 without REDUCE_JITTER.
  double ref_wnd_delay_scale() const { return ref_wnd_delay_scale_; }

 private:
  struct Base {
    Time since;
    Duration min;
  };
  void ForgetBase();
  bool Jumped(Time now, Duration owd, Duration way_back);
  void AddToBase(Time now, Duration owd, bool short_history);
  void CalculateRefWndDelayScale();
  bool UpdateDrift(Time now, Duration s_rtt);

  const Parameters& p_;
  std::deque<Base> history_;
  std::optional<Duration> base_;
  Duration qdelay_{0};
  RecentMin shortest_back_{5min};  // clocks drift, so an old minimum says nothing
  Duration qdelay_avg_{0};
  bool qdelay_avg_falls_ = false;
  Duration qdelay_max_avg_ = p_.qdelay_target_lo;
  Duration qdelay_min_avg_{0};
  Duration qdelay_dev_avg_{0};
  double ref_wnd_delay_scale_ = 1;
  Time last_update_qdelay_avg_time_{};
  // Clock drift:
  Duration slow_min_avg_{0};
  Duration min_this_rtt_ = Duration::max();
  Time rtt_start_{};
};

}  // namespace lidar::scream
