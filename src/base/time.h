// SPDX-License-Identifier: LGPL-2.1-or-later
// Types of times. There is no now(), because callers pass all times.
#pragma once
#include <chrono>
#include <cstdint>

namespace lidar {

/// A clock without now(), because callers pass all times.
struct Clock {
  using duration = std::chrono::nanoseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<Clock>;
  static constexpr bool is_steady = true;
};
using Duration = Clock::duration;
using Time = Clock::time_point;

constexpr double Seconds(Duration d) { return std::chrono::duration<double>(d).count(); }
constexpr double Milliseconds(Duration d) {
  return std::chrono::duration<double, std::milli>(d).count();
}
/// Converts seconds to a Duration. Rounds to the nearest nanosecond.
constexpr Duration FromSeconds(double s) {
  return Duration{static_cast<std::int64_t>(s * 1e9 + (s < 0 ? -0.5 : 0.5))};
}

}  // namespace lidar
