// SPDX-License-Identifier: LGPL-2.1-or-later
// Decides when to send the encoder an event with a new target bitrate.
#pragma once
#include <chrono>
#include <cmath>
#include <optional>

#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar {

/// Decides for one stream. ShouldNotify() returns true if the target has changed by more than
/// kThreshold since it last returned true, or if kInterval has passed since then.
class TargetNotifier {
 public:
  bool ShouldNotify(Time now, DataRate target) {
    if (last_ && now - time_ < kInterval && !Moved(target)) return false;
    last_ = target;
    time_ = now;
    return true;
  }
  void Reset() { last_.reset(); }

 private:
  bool Moved(DataRate target) const { return std::abs(target / *last_ - 1) > kThreshold; }
  static constexpr double kThreshold = 0.02;
  static constexpr Duration kInterval = std::chrono::milliseconds(200);
  std::optional<DataRate> last_;
  Time time_{};
};

}  // namespace lidar
