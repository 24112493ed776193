// SPDX-License-Identifier: LGPL-2.1-or-later
// Draft section "Competing Flows Compensation": the qdelay target gives way to loss-based flows.
#pragma once
#include <deque>

#include "src/scream/parameters.h"

namespace lidar::scream {

class CompetingFlows {
 public:
  explicit CompetingFlows(const Parameters& parameters)
      : p_(parameters), qdelay_target_(parameters.qdelay_target_lo) {}

  /// At each report; samples once every 50 ms.
  void Update(Time now, Duration qdelay, Duration s_rtt, bool loss);
  Duration qdelay_target() const { return qdelay_target_; }

 private:
  void CountLossEvents(Time now, Duration s_rtt, bool loss);
  void AdjustQdelayTarget();

  const Parameters& p_;
  Duration qdelay_target_;
  std::deque<double> qdelay_norm_history_;
  Time last_sample_{};
  Time rtt_start_{};
  bool loss_this_rtt_ = false;
  double loss_event_rate_ = 0;
};

}  // namespace lidar::scream
