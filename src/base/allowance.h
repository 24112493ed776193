// SPDX-License-Identifier: LGPL-2.1-or-later
// A token bucket: some events at once, and more as time passes.
#pragma once
#include "src/base/time.h"

namespace lidar {

class Allowance {
 public:
  /// Holds `most` tokens; taken tokens are restored, one in each `period`.
  Allowance(int most, Duration period) : most_(most), period_(period) {}

  /// Takes a token, and returns true, if more than `reserve` are left at `now`. If times go back,
  /// no token is restored.
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
