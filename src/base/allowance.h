// SPDX-License-Identifier: LGPL-2.1-or-later
// A token bucket: some events at once, and more as time passes.
#pragma once
#include "src/base/time.h"

namespace lidar {

class Allowance {
 public:
  /// Holds `most` tokens; a token that was taken comes back after `period`.
  Allowance(int most, Duration period) : most_(most), period_(period) {}

  /// Returns false if no token is left at `now` beside `reserve` others. If times go back, no token
  /// comes back.
  bool Take(Time now, int reserve = 0) {
    if (taken_ == 0) since_ = now;
    if (now > since_) {
      const auto back = (now - since_) / period_;
      taken_ = back < taken_ ? taken_ - static_cast<int>(back) : 0;
      since_ = taken_ == 0 ? now : since_ + back * period_;
    }
    if (taken_ >= most_ - reserve) return false;
    ++taken_;
    return true;
  }

 private:
  int most_;
  Duration period_;
  int taken_ = 0;
  Time since_{};  // time at which the last token came back
};

}  // namespace lidar
