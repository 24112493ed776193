// SPDX-License-Identifier: LGPL-2.1-or-later
// Smoothed round-trip time (RFC 6298) and its minimum.
#pragma once
#include <algorithm>
#include <optional>

#include "src/scream/model/recent_min.h"

namespace lidar::scream {

class RoundTripTime {
 public:
  void Add(Time now, Duration sample) {
    const Duration bounded = std::max(sample, kMin);
    last_ = bounded;
    min_.Add(now, bounded);
    if (smoothed_)
      *smoothed_ += FromSeconds(kGain * Seconds(bounded - *smoothed_));
    else
      smoothed_ = bounded;
  }
  void Restore(Duration smoothed) { smoothed_ = smoothed; }
  void Reset() { *this = RoundTripTime(); }

  bool known() const { return smoothed_.has_value(); }
  Duration smoothed() const { return smoothed_.value_or(kInitial); }
  /// Returns the minimum of the last 30 to 60 s. Older values do not count, because a path may
  /// become longer permanently.
  Duration min() const { return smoothed_ ? min_.value() : kInitial; }
  Duration last() const { return last_; }

 private:
  static constexpr Duration kMin = std::chrono::milliseconds(1);
  static constexpr Duration kInitial = std::chrono::milliseconds(100);
  static constexpr double kGain = 1.0 / 8;
  std::optional<Duration> smoothed_;
  RecentMin min_{std::chrono::seconds(30)};
  Duration last_ = kInitial;
};

}  // namespace lidar::scream
