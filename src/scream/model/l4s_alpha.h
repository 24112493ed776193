// SPDX-License-Identifier: LGPL-2.1-or-later
// Draft section "Receiving ECN-CE for L4S": the averaged fraction of marked packets.
#pragma once
#include <algorithm>

#include "src/scream/parameters.h"

namespace lidar::scream {

class L4sAlpha {
 public:
  explicit L4sAlpha(const Parameters& p) : p_(p) {}

  /// `round` is a round trip, or a frame period if that is longer. With the extension capacity, the
  /// fraction is measured over a whole round, and alpha rises as slowly as it falls, unless the
  /// capacity falls. There are two reasons: the fractions of few packets scatter, and a step AQM
  /// marks all packets of some rounds and no packets of others. If alpha rose fast and fell slowly,
  /// both would become a bias against the smaller of two flows.
  void Update(Time now, int data_units_acked, int data_units_acked_ce, Duration s_rtt,
              Duration round) {
    delivered_ += data_units_acked;
    marked_ += data_units_acked_ce;
    const bool even = p_.extensions.capacity;
    if (delivered_ == 0 || now - last_update_ < (even ? round : std::min(kUpdateInterval, s_rtt)))
      return;
    const double fraction =
        std::min(1.0, static_cast<double>(marked_) / static_cast<double>(delivered_));
    const double slow = std::max(1.0, Seconds(round) / Seconds(kEvenRound));
    const bool fall = even && CountsAsFall(fraction, round) && fraction >= alpha_;
    const double g = !even ? p_.l4s_avg_g : fall ? kFall : std::min(kFall, p_.even_alpha_g * slow);
    alpha_ = g * fraction + (1 - g) * alpha_;
    last_update_ = now;
    delivered_ = marked_ = 0;
  }

  void Reset() {
    alpha_ = 0;
    delivered_ = marked_ = marked_rounds_ = 0;
    last_update_ = {};
  }
  void Restore(double alpha) {
    alpha_ = alpha;
    marked_rounds_ = 0;
  }

  double value() const { return alpha_; }

 private:
  /// Counts the marked rounds in a row, and returns true if they show that the capacity has fallen.
  /// A step AQM marks one whole round, whereas a fall marks two rounds in a row. One long round is
  /// enough, because it has many packets.
  bool CountsAsFall(double fraction, Duration round) {
    marked_rounds_ = fraction < p_.even_alpha_max ? 0 : marked_rounds_ + 1;
    const int enough = round < p_.long_frame_period ? 2 : 1;
    return marked_rounds_ >= enough;
  }

  static constexpr double kFall = 1.0 / 8;
  static constexpr Duration kUpdateInterval = 10ms;
  /// Longer rounds, such as those of whole scans, have more weight.
  static constexpr Duration kEvenRound = 40ms;
  const Parameters& p_;
  double alpha_ = 0;
  Time last_update_{};
  int delivered_ = 0;
  int marked_ = 0;
  int marked_rounds_ = 0;  // rounds in a row with a fraction of even_alpha_max or more
};

}  // namespace lidar::scream
