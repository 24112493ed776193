// SPDX-License-Identifier: LGPL-2.1-or-later
// Smoothed round-trip time (RFC 6298) and its minimum.
#pragma once
#include <algorithm>
#include <cmath>
#include <optional>

#include "src/base/time.h"

namespace lidar::scream {

class RoundTripTime {
 public:
  /// `aged`: the older the average, the more a sample below it counts.
  explicit RoundTripTime(bool aged = true) : aged_(aged) {}

  /// A source that leaves the window unused sees short round trips that say little about
  /// the ones it would cause: such samples count for less (the draft's discussion).
  void Add(Time now, Duration sample, bool source_limited) {
    const Duration bounded = std::max(sample, kMin);
    last_ = bounded;
    AddToMin(now, bounded);
    if (!smoothed_) {
      smoothed_ = bounded;
    } else {
      const double age = Seconds(now - last_time_) / (kMemory * Seconds(*smoothed_));
      const double aged = aged_ && bounded < *smoothed_ ? 1 - std::exp(-age) : 0;
      const double gain = std::max(1.0 / (source_limited ? kSlow : kNormal), aged);
      *smoothed_ += FromSeconds(gain * Seconds(bounded - *smoothed_));
    }
    last_time_ = now;
  }
  /// The time since the last sample does not make the average older.
  void OnStandstill(Time now) { last_time_ = now; }
  /// Goes on from a value that was known before.
  void Restore(Duration smoothed) { smoothed_ = smoothed; }
  void Reset() { *this = RoundTripTime(aged_); }

  bool known() const { return smoothed_.has_value(); }
  Duration smoothed() const { return smoothed_.value_or(kInitial); }
  /// Looks back one to two kMinWindow: a path may become longer for good.
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
  static constexpr int kNormal = 8;
  static constexpr int kSlow = 32;
  static constexpr double kMemory = 8;  // round trips
  bool aged_;
  std::optional<Duration> smoothed_;
  Duration min_ = Duration::max();
  Duration previous_min_ = Duration::max();
  Time min_since_{};
  Time last_time_{};
  Duration last_ = kInitial;
};

}  // namespace lidar::scream
