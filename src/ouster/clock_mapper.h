// SPDX-License-Identifier: LGPL-2.1-or-later
// Maps the sensor's clock to the receiver's, by the arrival of packets.
#pragma once
#include <cstdint>
#include <optional>

#include "src/base/time.h"

namespace lidar::ouster {

/// Only damaged packets have times after 2096. Below this bound sums and differences of times do
/// not overflow.
constexpr Duration kLatestTime{4'000'000'000'000'000'000};

constexpr Duration SinceSensorEpoch(std::uint64_t sensor_ns) {
  const auto latest = static_cast<std::uint64_t>(kLatestTime.count());
  return Duration(static_cast<std::int64_t>(sensor_ns < latest ? sensor_ns : latest));
}

/// The fastest packet shows the offset between the clocks best. So the offset is the minimum of
/// (arrival - sampling) over the last seconds: it ignores jitter and follows drift. A jump of
/// either clock restarts it.
class ClockMapper {
 public:
  enum class Mode {
    kFollow,  // live: as described above
    kHold,    // files: the first packet sets the offset, so that times step as the sensor's do
  };
  explicit ClockMapper(Mode mode) : mode_(mode) {}

  /// Notes that a packet with a column sampled at `sensor_ns` arrived at `arrival`.
  void Observe(std::uint64_t sensor_ns, Time arrival);
  /// Returns true if Observe() would find a clock jump. If so, first call Map() for the data from
  /// before the jump.
  bool WouldJump(std::uint64_t sensor_ns, Time arrival) const;
  /// Lets the next packet set the offset anew.
  void Reset() { offset_.reset(); }
  /// Notes that the receiver's clock was put forward by `step`.
  void Shift(Duration step);
  /// Returns true after Observe(), until Reset().
  bool is_set() const { return offset_.has_value(); }
  /// Call only if is_set().
  Time Map(std::uint64_t sensor_ns) const;

 private:
  static constexpr Duration kJump = std::chrono::seconds(1);
  static constexpr Duration kWindow = std::chrono::seconds(4);
  static constexpr std::int64_t kMaxSlewPpm = 500;

  Mode mode_;
  std::optional<Duration> offset_;  // to add to the sensor's time
  Duration minimum_{};              // of this window
  Duration last_minimum_{};         // of the last window
  Time window_start_{};
  Time last_arrival_{};
  Duration last_sensor_{};
};

}  // namespace lidar::ouster
