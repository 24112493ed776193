// SPDX-License-Identifier: LGPL-2.1-or-later
// Decides from a robot's received bytes whether it is present, and how far it exceeds its limit.
#pragma once
#include <algorithm>
#include <cstdint>
#include <utility>

#include "src/base/time.h"

namespace lidar::edge {

class RobotWatch {
 public:
  static constexpr Duration kTimeout = std::chrono::seconds(10);  // silence of a robot that left
  static constexpr double kCredit = 3;  // seconds of data that a robot may send beyond its limit

  /// 0: no limit.
  explicit RobotWatch(double max_mbps) : limit_(max_mbps * 125'000) {}

  /// Begins a session, which counts bytes from 0. Keeps the excess of earlier sessions.
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
  /// Returns how long to shut out a robot that exceeds its limit by more than kCredit, so that its
  /// mean stays below the limit; 0 for others.
  Duration ToShutOut() const {
    const bool is_ahead = limit_ > 0 && ahead_ > kCredit * limit_;
    return is_ahead ? FromSeconds(ahead_ / limit_) : Duration{};
  }

 private:
  double limit_;  // bytes a second
  double ahead_ = 0;
  std::uint64_t bytes_ = 0;
  bool is_there_ = false;
  Time heard_at_{};
  Time noted_at_{};
};

}  // namespace lidar::edge
