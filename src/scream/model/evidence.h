// SPDX-License-Identifier: LGPL-2.1-or-later
// The sending times from which on packets are evidence about the current path.
#pragma once
#include <algorithm>

#include "src/scream/model/sent_history.h"

namespace lidar::scream {

/// Decides by its sending time whether a packet counts. The marks, losses, delays and round trips
/// of packets that met a gap, an outage or another route do not count. Packets that were in flight
/// when the sender reacted to congestion do not cause a second reaction.
class Evidence {
 public:
  void BeginAt(Time time) {
    begin_ = std::max(begin_, time);
    OnDropReaction(begin_);
  }
  /// Call it after the window was reduced because the capacity had fallen.
  void OnDropReaction(Time now) {
    marks_ = std::max(marks_, now);
    OnLossReaction(now);
  }
  void OnLossReaction(Time now) { losses_ = std::max(losses_, now); }

  bool Counts(Time sent) const { return sent >= begin_; }
  bool MarkCounts(Time sent) const { return sent >= marks_; }
  bool LossCounts(Time sent) const { return sent >= losses_; }
  /// Returns true if the newest packet that the report acknowledges counts, or if the report
  /// acknowledges no packet.
  bool Counts(const AckSummary& acks) const {
    return acks.acked.empty() || Counts(acks.acked.back().sent);
  }

 private:
  // `marks_` and `losses_` are never before `begin_`.
  Time begin_{}, marks_{}, losses_{};
};

}  // namespace lidar::scream
