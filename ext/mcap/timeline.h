// SPDX-License-Identifier: LGPL-2.1-or-later
// Log times of messages, which count from 1970 and advance with the running time.
#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>

namespace lidar::gst {

/// Computes log times. All times are in nanoseconds, and log times count from 1970.
class Timeline {
 public:
  struct Moment {
    std::optional<std::uint64_t> running_time;
    std::optional<std::uint64_t> capture_time;
    std::uint64_t now = 0;
  };

  /// Returns the log time of a buffer. The log time of the first buffer is its capture time, or
  /// `now` if it has none. Log times of later buffers differ by as much as their running times.
  std::uint64_t LogTime(const Moment& at) {
    if (!at.running_time) return last_ > 0 ? last_ : at.capture_time.value_or(at.now);
    if (!origin_) {
      const std::uint64_t first = std::max(at.capture_time.value_or(at.now), last_);
      origin_ = first - *at.running_time;
    }
    const std::uint64_t time = *origin_ + *at.running_time;
    last_ = std::max(last_, time);
    return time;
  }
  /// Must be called when running times restart within a recording. The next buffer then counts as
  /// the first, but its log time is at least the last log time.
  void Restart() { origin_.reset(); }

 private:
  std::optional<std::uint64_t> origin_;  // log time of running time 0; may wrap below 0
  std::uint64_t last_ = 0;
};

}  // namespace lidar::gst
