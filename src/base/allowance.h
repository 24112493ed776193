// SPDX-License-Identifier: LGPL-2.1-or-later
// A token bucket. It allows a number of events at once, and more events as time passes.
#pragma once
#include "src/base/time.h"

namespace lidar {

class Allowance {
 public:
  /// The bucket begins with `most` tokens. Afterwards one used token is restored after each
  /// `period`.
  Allowance(int most, Duration period) : most_(most), period_(period) {}

  /// Takes a token and returns true if more than `reserve` tokens are left at `now`. If `now` is
  /// before an earlier time, no token is restored.
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
  Time since_{};  // time at which the last token was restored
};

}  // namespace lidar
