// SPDX-License-Identifier: LGPL-2.1-or-later
// Pauses before repeated attempts: each pause is twice the last one, up to a limit.
#pragma once
#include <algorithm>

#include "src/base/time.h"

namespace lidar {

class Backoff {
 public:
  Backoff(Duration first, Duration most) : first_(first), most_(most), next_(first) {}

  /// Returns the pause before the next attempt.
  Duration Next() {
    const Duration pause = next_;
    next_ = std::min(2 * next_, most_);
    return pause;
  }
  /// Makes the next pause as short as the first one. Call it after a success.
  void Reset() { next_ = first_; }

 private:
  Duration first_;
  Duration most_;
  Duration next_;
};

}  // namespace lidar
