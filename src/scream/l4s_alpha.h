// SPDX-License-Identifier: LGPL-2.1-or-later
// Draft section "Receiving ECN-CE for L4S": the averaged fraction of marked packets.
#pragma once
#include <algorithm>

#include "scream/parameters.h"

namespace lidar::scream {

/// Fast attack, slow decay.
class L4sAlpha {
 public:
  explicit L4sAlpha(const Parameters& p) : up_(p.l4s_avg_g_up), down_(p.l4s_avg_g_down) {}

  void Update(Time now, int data_units_acked, int data_units_acked_ce, Duration s_rtt) {
    delivered_ += data_units_acked;
    marked_ += data_units_acked_ce;
    if (delivered_ == 0 || now - last_update_ < std::min(kUpdateInterval, s_rtt)) return;
    last_fraction_marked_ =
        std::min(1.0, static_cast<double>(marked_) / static_cast<double>(delivered_));
    if (last_fraction_marked_ >= alpha_)
      alpha_ = up_ * last_fraction_marked_ + (1 - up_) * alpha_;
    else
      alpha_ *= 1 - down_;
    last_update_ = now;
    delivered_ = marked_ = 0;
  }

  double value() const { return alpha_; }
  double last_fraction_marked() const { return last_fraction_marked_; }
  void Raise(double alpha) { alpha_ = std::max(alpha_, alpha); }

 private:
  static constexpr Duration kUpdateInterval = 10ms;
  double up_;
  double down_;
  double alpha_ = 0;
  double last_fraction_marked_ = 0;
  Time last_update_{};
  int delivered_ = 0;
  int marked_ = 0;
};

}  // namespace lidar::scream
