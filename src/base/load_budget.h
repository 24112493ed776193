// SPDX-License-Identifier: LGPL-2.1-or-later
// Limits the processor time that a task uses in the long run.
#pragma once
#include <algorithm>
#include <optional>

#include "src/base/time.h"

namespace lidar {

class LoadBudget {
 public:
  /// Unused processor time is saved up to the amount that is allowed in this period.
  static constexpr Duration kUnusedTimeKept = std::chrono::seconds(1);

  /// Returns true unless the task has used more processor time up to `now` than allowed. `load` is
  /// the allowed processor time divided by the elapsed time. `now` must not decrease.
  bool Allows(double load, Time now) {
    if (last_) saved_ += FromSeconds(load * Seconds(now - *last_));
    last_ = now;
    saved_ = std::min(saved_, FromSeconds(load * Seconds(kUnusedTimeKept)));
    return saved_ >= Duration{};
  }
  void Spend(Duration processor_time) { saved_ -= processor_time; }

 private:
  Duration saved_{};  // negative if too much time was used
  std::optional<Time> last_;
};

}  // namespace lidar
