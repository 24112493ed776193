// SPDX-License-Identifier: LGPL-2.1-or-later
// Counts the bytes that are received from a robot. Decides whether the robot is present, and how
// far it exceeds its limit.
#pragma once
#include <algorithm>
#include <cstdint>
#include <utility>

#include "src/base/time.h"

namespace lidar::edge {

class RobotWatch {
 public:
  // A robot is gone if it is silent for longer.
  static constexpr Duration kTimeout = std::chrono::seconds(10);
  static constexpr double kCredit = 3;  // seconds of data that a robot may send beyond its limit

  /// If `max_mbps` is 0, there is no limit.
  explicit RobotWatch(double max_mbps) : limit_(max_mbps * 125'000) {}

  /// Begins a session, in which the number of received bytes begins at 0. The excess of earlier
  /// sessions still counts.
  void Begin() {
    bytes_ = 0;
    is_there_ = false;
  }
  /// Notes that the session has received `bytes` so far.
  void Note(Time now, std::uint64_t bytes) {
    const auto more = bytes - std::min(std::exchange(bytes_, bytes), bytes);
    if (more > 0) {
      is_there_ = true;
      heard_at_ = now;
    }
    const Duration passed = now - std::exchange(noted_at_, now);
    ahead_ = std::max(0.0, ahead_ - limit_ * Seconds(passed)) + static_cast<double>(more);
  }

  bool is_there() const { return is_there_; }
  bool IsGone() const { return is_there_ && noted_at_ - heard_at_ > kTimeout; }
  /// Returns how long to shut the robot out so that its mean rate stays below the limit. Returns 0
  /// unless the robot is more than kCredit seconds of data ahead of its limit.
  Duration ToShutOut() const {
    const bool is_ahead = limit_ > 0 && ahead_ > kCredit * limit_;
    return is_ahead ? FromSeconds(ahead_ / limit_) : Duration{};
  }

 private:
  double limit_;  // bytes per second
  double ahead_ = 0;
  std::uint64_t bytes_ = 0;
  bool is_there_ = false;
  Time heard_at_{};
  Time noted_at_{};
};

}  // namespace lidar::edge
