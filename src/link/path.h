// SPDX-License-Identifier: LGPL-2.1-or-later
// Effects on packets after the bottleneck: jitter, bursts, reordering, duplication.
#pragma once
#include <algorithm>

#include "src/base/time.h"
#include "src/link/random.h"

namespace lidar::link {

struct PathConfig {
  Duration jitter{0};          // extra delay between 0 and this; keeps the order
  Duration burst_interval{0};  // packets leave only at multiples of this; 0: at once
  double reorder = 0;          // probability that a packet is delayed by reorder_delay
  Duration reorder_delay = std::chrono::milliseconds{5};
  double duplicate = 0;  // probability that a packet arrives twice
  int jitter_draws = 1;  // number of uniform draws that are averaged; 3 are nearly a Gaussian
};

class Path {
 public:
  Path(const PathConfig& config, std::uint64_t seed) : config_(config), random_(seed) {}

  /// Returns the arrival time of a packet that would arrive at `t` on an ideal path. `t` must not
  /// decrease from one call to the next.
  Time Arrival(Time t) {
    if (config_.jitter > Duration{0})
      for (int i = 0; i < config_.jitter_draws; ++i)
        t += FromSeconds(Seconds(config_.jitter) * random_.Uniform() / config_.jitter_draws);
    if (config_.burst_interval > Duration{0}) {
      const auto phase = t.time_since_epoch() % config_.burst_interval;
      if (phase > Duration{0}) t += config_.burst_interval - phase;
    }
    if (random_.Chance(config_.reorder)) return t + config_.reorder_delay;
    latest_ = std::max(latest_, t);
    return latest_;
  }
  bool Duplicates() { return random_.Chance(config_.duplicate); }

 private:
  PathConfig config_;
  Random random_;
  Time latest_{};
};

}  // namespace lidar::link
