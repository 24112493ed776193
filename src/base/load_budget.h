// SPDX-License-Identifier: LGPL-2.1-or-later
// Bounds the processor time of a piece of work in the long run.
#pragma once
#include <algorithm>
#include <optional>

#include "src/base/time.h"

namespace lidar {

class LoadBudget {
 public:
  /// Unused time is saved, but not more than is allowed in this period.
  static constexpr Duration kUnusedTimeKept = std::chrono::seconds(1);

  /// `load` is the allowed processor time divided by elapsed time. Returns false while more
  /// processor time than allowed was spent up to `now`. Times must not go back.
  bool Allows(double load, Time now) {
    if (last_) saved_ += FromSeconds(load * Seconds(now - *last_));
    last_ = now;
    saved_ = std::min(saved_, FromSeconds(load * Seconds(kUnusedTimeKept)));
    return saved_ >= Duration{};
  }
  void Spend(Duration processor_time) { saved_ -= processor_time; }

 private:
  Duration saved_{};  // negative: overspent
  std::optional<Time> last_;
};

}  // namespace lidar
