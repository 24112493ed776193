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
  /// The excess of the round trip over its minimum. It is an upper bound of the queueing delay.
  Duration rtt_excess{0};
  /// The time between the report, on the receiver's clock, and its arrival, on our clock.
  Duration way_back{0};
};

/// Measures the queueing delay as the one-way delay above its base (RFC 6817). The clocks of sender
/// and receiver have no common epoch, so that only differences of one-way delays have a meaning.
class QueueDelay {
 public:
  explicit QueueDelay(const Parameters& parameters) : p_(parameters) {}

  /// Adds a packet. If the clocks have jumped relative to each other, starts a new base and returns
  /// false. If `short_history` is true, the base is the minimum of the last half minute.
  bool Add(Time now, const DelaySample& sample, bool short_history = false);
  /// Updates the averages. Call it after the packets of a report were added. The averages change at
  /// most once every min(VIRTUAL_RTT, s_rtt). Returns true if the clock-drift remedy starts a new
  /// base.
  bool Update(Time now, Duration s_rtt);
  void ForgetQueue() { qdelay_avg_ = Duration{0}; }
  void Reset();

  Duration base() const { return base_.value_or(Duration{0}); }
  Duration qdelay() const { return qdelay_; }
  Duration qdelay_avg() const { return qdelay_avg_; }
  /// Returns true if qdelay_avg fell at its last update.
  bool qdelay_avg_falls() const { return qdelay_avg_falls_; }
  /// Returns a value from 0 (much jitter) to 1 (no jitter). It is always 1 without REDUCE_JITTER.
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
