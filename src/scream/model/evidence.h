// SPDX-License-Identifier: LGPL-2.1-or-later
// The time from which packets say something about the present path.
#pragma once
#include <algorithm>

#include "src/scream/model/sent_history.h"

namespace lidar::scream {

/// The marks, losses, delays and round trips of packets that met a gap, an outage or another route
/// do not count. Packets that were under way at a reaction cause no other reaction.
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
  /// Returns true if the newest packet of the report counts, or if it has no time.
  bool Counts(const AckSummary& acks) const {
    return acks.acked.empty() || Counts(acks.acked.back().sent);
  }
  bool NewLoss(const AckSummary& acks) const {
    return std::any_of(acks.lost.begin(), acks.lost.end(),
                       [this](const SentRecord& lost) { return lost.sent >= losses_; });
  }
  bool NewMark(const AckSummary& acks) const {
    const auto is_new = [this](const AckedPacket& acked) {
      return acked.arrived_ecn == Ecn::kCe && MarkCounts(acked.sent);
    };
    return std::any_of(acks.late_ce.begin(), acks.late_ce.end(),
                       [this](Time sent) { return MarkCounts(sent); }) ||
           std::any_of(acks.acked.begin(), acks.acked.end(), is_new);
  }

 private:
  // `marks_` and `losses_` are never before `begin_`.
  Time begin_{}, marks_{}, losses_{};
};

}  // namespace lidar::scream
