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
    last_sensor_ = SinceSensorEpoch(sensor_ns);
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
  // The offset rises at most as fast as clocks drift. It falls by at most half of the time that has
  // passed on the sensor's clock, because mapped times must not go backwards.
  const Duration elapsed = std::max(Duration{0}, arrival - last_arrival_);
  const Duration sampled = std::max(Duration{0}, SinceSensorEpoch(sensor_ns) - last_sensor_);
  offset_ =
      std::clamp(target, *offset_ - sampled / 2, *offset_ + elapsed * kMaxSlewPpm / 1'000'000);
  last_arrival_ = std::max(last_arrival_, arrival);
  last_sensor_ = std::max(last_sensor_, SinceSensorEpoch(sensor_ns));
}

void ClockMapper::Shift(Duration step) {
  if (!offset_) return;
  *offset_ += step;
  for (Duration* minimum : {&minimum_, &last_minimum_}) *minimum += step;
  for (Time* time : {&window_start_, &last_arrival_}) *time += step;
}

Time ClockMapper::Map(std::uint64_t sensor_ns) const {
  return Time(SinceSensorEpoch(sensor_ns) + offset_.value_or(Duration{0}));
}

}  // namespace lidar::ouster
