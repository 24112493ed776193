// SPDX-License-Identifier: LGPL-2.1-or-later
// Draft section "Link layer losses and rate policers": the window that a policer lets through.
#pragma once
#include <algorithm>
#include <limits>

#include "src/scream/parameters.h"

namespace lidar::scream {

/// The draft lifts the limit by a thousandth each round trip. With the extension brief_policer it
/// is believed for a second at first, as one burst of loss is no policer. Where loss comes back
/// soon after, it is believed for longer.
class Policer {
 public:
  explicit Policer(const Parameters& parameters) : p_(parameters) {}

  /// Loss beyond LOSS_RATE_THRESHOLD_POLICER without a queue.
  void OnLoss(Time now, double ref_wnd) {
    if (max_ == kNone && p_.extensions.brief_policer) {
      const bool again = lifted_ != Time{} && now - lifted_ < kSoon * belief_;
      belief_ = again ? std::min(kLongest, kLonger * belief_) : kShortest;
    }
    max_ = ref_wnd * p_.beta_loss_policer;
    last_loss_ = now;
  }
  /// Once a round trip.
  void Relax(Time now) {
    max_ *= 1 + p_.policed_ref_wnd_recovery;
    if (!p_.extensions.brief_policer || max_ == kNone || now - last_loss_ < belief_) return;
    max_ = kNone;
    lifted_ = now;
  }
  double max() const { return max_; }

 private:
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  static constexpr Duration kShortest = 1s;
  static constexpr Duration kLongest = 64s;
  static constexpr int kLonger = 4;
  static constexpr int kSoon = 4;
  const Parameters& p_;
  double max_ = kNone;
  Duration belief_ = kShortest;
  Time last_loss_{};
  Time lifted_{};
};

}  // namespace lidar::scream
