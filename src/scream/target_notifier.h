// SPDX-License-Identifier: LGPL-2.1-or-later
// Decides when a changed target bitrate is worth an event to the encoder.
#pragma once
#include <cmath>
#include <optional>

#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar::scream {
using namespace std::chrono_literals;

/// Serves one stream. Returns true if the target moved by more than `threshold` since the last
/// true, or after `interval`.
class TargetNotifier {
 public:
  bool ShouldNotify(Time now, DataRate target) {
    if (last_ && now - time_ < interval_ && !Moved(target)) return false;
    last_ = target;
    time_ = now;
    return true;
  }
  void Reset() { last_.reset(); }

 private:
  bool Moved(DataRate target) const { return std::abs(target / *last_ - 1) > threshold_; }
  static constexpr double threshold_ = 0.02;
  static constexpr Duration interval_ = 200ms;
  std::optional<DataRate> last_;
  Time time_{};
};

}  // namespace lidar::scream
