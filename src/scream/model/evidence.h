// SPDX-License-Identifier: LGPL-2.1-or-later
// The time from which packets say something about the present path.
#pragma once
#include <algorithm>

#include "src/scream/model/sent_history.h"

namespace lidar::scream {

/// The marks, losses, delays and round trips of packets that met a gap, an outage or another route
/// do not count. Packets that were under way at a reaction cause no second reaction.
class Evidence {
 public:
  void BeginAt(Time time) {
    begin_ = std::max(begin_, time);
    OnDropReaction(begin_);
  }
  /// Called after the window has followed a fall of the capacity.
  void OnDropReaction(Time now) {
    marks_ = std::max(marks_, now);
    OnLossReaction(now);
  }
  void OnLossReaction(Time now) { losses_ = std::max(losses_, now); }

  bool Counts(Time sent) const { return sent >= begin_; }
  bool MarkCounts(Time sent) const { return sent >= marks_; }
  bool LossCounts(Time sent) const { return sent >= losses_; }
  /// Returns true if the newest packet of the report counts, or if no packet is acknowledged.
  bool Counts(const AckSummary& acks) const {
    return acks.acked.empty() || Counts(acks.acked.back().sent);
  }

 private:
  // `marks_` and `losses_` are never before `begin_`.
  Time begin_{}, marks_{}, losses_{};
};

}  // namespace lidar::scream
