// SPDX-License-Identifier: LGPL-2.1-or-later
// Maps times of the sensor's clock to the receiver's clock, by the arrival times of packets.
#pragma once
#include <cstdint>
#include <optional>

#include "src/base/time.h"

namespace lidar::ouster {

/// The latest time that is used; it is in the year 2096, so only damaged packets have later times.
/// Sums and differences of times up to this limit do not overflow.
constexpr Duration kLatestTime{4'000'000'000'000'000'000};

constexpr Duration SinceSensorEpoch(std::uint64_t sensor_ns) {
  const auto latest = static_cast<std::uint64_t>(kLatestTime.count());
  return Duration(static_cast<std::int64_t>(sensor_ns < latest ? sensor_ns : latest));
}

/// Estimates the offset between the sensor's clock and the receiver's clock from (arrival time -
/// sampling time) of packets. The packet with the least delay shows the offset best, so the offset
/// is the minimum over the last seconds. The minimum ignores jitter and follows the drift of the
/// clocks. If either clock jumps, the estimate starts anew.
class ClockMapper {
 public:
  enum class Mode {
    kFollow,  // for live sensors: as described above
    // For files: the first packet sets the offset for good, so that the differences between mapped
    // times equal the differences between the sensor's times.
    kHold,
  };
  explicit ClockMapper(Mode mode) : mode_(mode) {}

  /// Notes that a packet with a column sampled at `sensor_ns` arrived at `arrival`.
  void Observe(std::uint64_t sensor_ns, Time arrival);
  /// Returns true if Observe() with these arguments would find a clock jump and set a new offset.
  /// In this case, call Map() for all data from before the jump first.
  bool WouldJump(std::uint64_t sensor_ns, Time arrival) const;
  /// Makes the next packet set a new offset.
  void Reset() { offset_.reset(); }
  /// Notes that the receiver's clock was put forward by `step`.
  void Shift(Duration step);
  /// Returns true if an offset is known: after the first Observe(), and until Reset().
  bool is_set() const { return offset_.has_value(); }
  /// Returns the receiver's time of `sensor_ns`. Call it only if is_set() is true.
  Time Map(std::uint64_t sensor_ns) const;

 private:
  static constexpr Duration kJump = std::chrono::seconds(1);
  static constexpr Duration kWindow = std::chrono::seconds(4);
  static constexpr std::int64_t kMaxSlewPpm = 500;

  Mode mode_;
  std::optional<Duration> offset_;  // add this to a time of the sensor
  Duration minimum_{};              // within the current window
  Duration last_minimum_{};         // within the window before it
  Time window_start_{};
  Time last_arrival_{};
  Duration last_sensor_{};
};

}  // namespace lidar::ouster
