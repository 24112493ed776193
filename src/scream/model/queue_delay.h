// SPDX-License-Identifier: LGPL-2.1-or-later
// Draft section "Detecting Increased Queue Delay", with its jitter scale and clock-drift remedy.
#pragma once
#include <deque>
#include <optional>

#include "src/scream/parameters.h"

namespace lidar::scream {

/// A packet that was acknowledged.
struct DelaySample {
  Time sent{};
  Time arrival{};  ///< on the receiver's clock
  /// How much the round trip is above its minimum: a queue cannot delay more than that.
  Duration rtt_excess{0};
  /// From the report on the receiver's clock to its arrival on ours.
  Duration way_back{0};
};

/// One-way delay above its base (RFC 6817). The two clocks share no epoch: only differences count.
class QueueDelay {
 public:
  explicit QueueDelay(const Parameters& parameters);

  /// Returns false where the clocks jumped against each other: the base has been taken anew.
  /// `short_history`: the base is that of the last half minute.
  bool Add(Time now, const DelaySample& sample, bool short_history = false);
  /// After the packets of a report: averages, at most once every min(VIRTUAL_RTT, s_rtt).
  void Update(Time now, Duration s_rtt, Duration qdelay_target);
  /// Takes no account any more of the queue that was.
  void ForgetQueue() { qdelay_avg_ = Duration{0}; }
  /// As new.
  void Reset();

  Duration base() const { return base_.value_or(Duration{0}); }
  Duration qdelay() const { return qdelay_; }
  Duration qdelay_avg() const { return qdelay_avg_; }
  /// 1: no jitter, 0: much. Always 1 without REDUCE_JITTER.
  double ref_wnd_delay_scale() const { return ref_wnd_delay_scale_; }
  /// True once each time the clock-drift remedy gave the base up.
  bool TakeDriftReset();

 private:
  struct Base {
    Time since;
    Duration min;
  };
  void ForgetBase();
  bool Jumped(Time now, Duration owd, Duration way_back);
  void AddToBase(Time now, Duration owd, bool short_history);
  void CalculateRefWndDelayScale();
  void UpdateDrift(Time now, Duration s_rtt, Duration qdelay_target);

  const Parameters& p_;
  std::deque<Base> history_;
  std::optional<Duration> base_;
  Duration qdelay_{0};
  std::optional<Duration> shortest_back_, previous_shortest_back_;
  Time shortest_back_since_{};
  Duration qdelay_avg_{0};
  Duration qdelay_max_avg_;
  Duration qdelay_min_avg_{0};
  Duration qdelay_dev_avg_{0};
  double ref_wnd_delay_scale_ = 1;
  Time last_update_qdelay_avg_time_{};
  // Clock drift
  Duration slow_min_avg_{0};
  Duration min_this_rtt_ = Duration::max();
  Time rtt_start_{};
  bool drift_reset_ = false;
};

}  // namespace lidar::scream
