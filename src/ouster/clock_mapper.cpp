// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/ouster/clock_mapper.h"

#include <algorithm>

namespace lidar::ouster {

bool ClockMapper::WouldJump(std::uint64_t sensor_ns, Time arrival) const {
  if (!offset_) return false;
  const Duration seen = arrival.time_since_epoch() - SinceSensorEpoch(sensor_ns);
  return seen - *offset_ > kJump || *offset_ - seen > kJump;
}

void ClockMapper::Observe(std::uint64_t sensor_ns, Time arrival) {
  const Duration seen = arrival.time_since_epoch() - SinceSensorEpoch(sensor_ns);
  if (!offset_ || WouldJump(sensor_ns, arrival)) {
    offset_ = minimum_ = last_minimum_ = seen;
    window_start_ = last_arrival_ = arrival;
    return;
  }
  if (mode_ == Mode::kHold) return;
  if (arrival - window_start_ > kWindow) {
    last_minimum_ = minimum_;
    minimum_ = seen;
    window_start_ = arrival;
  }
  minimum_ = std::min(minimum_, seen);
  const Duration target = std::min(minimum_, last_minimum_);
  // The offset falls at once to that of a faster packet, and rises at most as fast as clocks drift.
  const Duration elapsed = std::max(Duration{0}, arrival - last_arrival_);
  const Duration step = elapsed * kMaxSlewPpm / 1'000'000;
  offset_ = std::min(target, *offset_ + step);
  last_arrival_ = std::max(last_arrival_, arrival);
}

Time ClockMapper::Map(std::uint64_t sensor_ns) const {
  return Time(SinceSensorEpoch(sensor_ns) + offset_.value_or(Duration{0}));
}

}  // namespace lidar::ouster
