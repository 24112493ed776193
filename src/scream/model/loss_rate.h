// SPDX-License-Identifier: LGPL-2.1-or-later
// Draft section "Link layer losses and rate policers": the averaged loss rate.
#pragma once
#include <algorithm>

#include "src/scream/parameters.h"

namespace lidar::scream {

class LossRate {
 public:
  explicit LossRate(const Parameters& p) : p_(p) {}
  /// Adds a packet that was acknowledged or lost.
  void Add(bool lost, DataSize ref_wnd) {
    const double alpha = std::min(p_.loss_rate_threshold / 4, p_.mss / ref_wnd / 2);
    rate_ = (1 - alpha) * rate_ + (lost ? alpha : 0);
  }
  void Reset() { rate_ = 0; }
  double value() const { return rate_; }

 private:
  const Parameters& p_;
  double rate_ = 0;
};

}  // namespace lidar::scream
