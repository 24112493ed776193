// SPDX-License-Identifier: LGPL-2.1-or-later
// Smoothed round-trip time (RFC 6298) and its minimum.
#pragma once
#include <algorithm>
#include <optional>

#include "src/base/time.h"

namespace lidar::scream {

class RoundTripTime {
 public:
  void Add(Time now, Duration sample) {
    const Duration bounded = std::max(sample, kMin);
    last_ = bounded;
    AddToMin(now, bounded);
    if (smoothed_)
      *smoothed_ += FromSeconds(kGain * Seconds(bounded - *smoothed_));
    else
      smoothed_ = bounded;
  }
  void Restore(Duration smoothed) { smoothed_ = smoothed; }
  void Reset() { *this = RoundTripTime(); }

  bool known() const { return smoothed_.has_value(); }
  Duration smoothed() const { return smoothed_.value_or(kInitial); }
  /// Minimum over one to two kMinWindow, as a path may become longer permanently.
  Duration min() const { return smoothed_ ? std::min(min_, previous_min_) : kInitial; }
  Duration last() const { return last_; }

 private:
  void AddToMin(Time now, Duration sample) {
    if (now - min_since_ >= kMinWindow) {
      previous_min_ = min_;
      min_ = sample;
      min_since_ = now;
    }
    min_ = std::min(min_, sample);
  }

  static constexpr Duration kMinWindow = std::chrono::seconds(30);
  static constexpr Duration kMin = std::chrono::milliseconds(1);
  static constexpr Duration kInitial = std::chrono::milliseconds(100);
  static constexpr double kGain = 1.0 / 8;
  std::optional<Duration> smoothed_;
  Duration min_ = Duration::max();
  Duration previous_min_ = Duration::max();
  Time min_since_{};
  Duration last_ = kInitial;
};

}  // namespace lidar::scream
