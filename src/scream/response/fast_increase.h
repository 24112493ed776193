// SPDX-License-Identifier: LGPL-2.1-or-later
// Extension capacity: multiplicative growth at the start and after rounds without congestion.
#pragma once
#include <algorithm>

#include "src/scream/model/path_model.h"
#include "src/scream/parameters.h"

namespace lidar::scream {

/// Fast growth starts after a few rounds without congestion, and increases with each further round.
/// A round is a round trip, or a frame period if that is longer, because the marks of a source of
/// frames arrive once per frame.
class FastIncrease {
 public:
  explicit FastIncrease(const Parameters& p) : p_(p) {}

  void OnCongestion(Time now) {
    rounds_ = 0;
    round_start_ = now;
    starting_ = false;
  }
  void Update(Time now, Duration round) {
    if (now - round_start_ < round) return;
    round_start_ = now;
    ++rounds_;
  }
  /// Call it after a gap or an outage. The window then grows as it does at the start of a flow.
  void Restart() { starting_ = true; }
  /// Returns the fraction of the acknowledged bytes by which the window may grow. The fraction is
  /// smaller if the queue is longer.
  double growth(Time now, const PathModel& path, Duration frame_period) const {
    if (!p_.extensions.capacity) return 0;
    const int bold = std::max(0, rounds_ - p_.fast_increase_rounds);
    const double step = path.L4sWorks(now) ? p_.fast_increase_step : p_.fast_increase_step_unmarked;
    // If frames are rare, a round is long, and data in excess stay queued for a round. The start is
    // therefore slower.
    const double round = Seconds(path.Round(frame_period));
    const double start =
        p_.fast_increase_max * std::clamp(Seconds(p_.long_frame_period) / round, 0.5, 1.0);
    const double growth = starting_ ? start : std::min(p_.fast_increase_max, step * bold);
    const double queue = Seconds(path.queue_delay().qdelay()) / Seconds(p_.busy_qdelay);
    const double beside = path.loss_context().AtFullQueue() ? p_.fast_increase_beside : 1;
    return growth * std::clamp(1 - queue, 0.0, 1.0) * beside;
  }

 private:
  const Parameters& p_;
  bool starting_ = true;
  int rounds_ = 0;
  Time round_start_{};
};

}  // namespace lidar::scream
