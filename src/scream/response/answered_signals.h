// SPDX-License-Identifier: LGPL-2.1-or-later
// Extension answered_signals: which signs of congestion have had their reaction.
#pragma once
#include <algorithm>

#include "src/scream/model/sent_history.h"
#include "src/scream/parameters.h"

namespace lidar::scream {

/// A window that was reduced for loss is not reduced again for losses of packets that were on the
/// way by then. After a capacity drop and an outage the same holds for marks.
class AnsweredSignals {
 public:
  explicit AnsweredSignals(const Parameters& parameters) : p_(parameters) {}

  void OnLossReaction(Time now) {
    if (p_.extensions.answered_signals) losses_ = now;
  }
  void OnCapacityDrop(Time now) {
    if (p_.extensions.answered_signals) losses_ = marks_ = now;
  }
  /// What the path held back comes first: marks behind it are answered with the restart.
  void OnOutageEnd(Time now, Duration s_rtt) { losses_ = marks_ = now + s_rtt; }

  /// What was sent on another route says nothing about this one.
  void OnRouteChange(Time now) { losses_ = marks_ = now; }

  /// The queue that a gap left is no sign of congestion.
  void OnGapEnd(Time now) { losses_ = marks_ = std::max(marks_, now); }

  bool NewLoss(const AckSummary& acks) const {
    return std::any_of(acks.lost.begin(), acks.lost.end(),
                       [this](const LostPacket& lost) { return lost.sent >= losses_; });
  }
  bool NewMark(const AckSummary& acks) const {
    const auto is_new = [this](const AckedPacket& acked) {
      return acked.arrived_ecn == Ecn::kCe && acked.sent >= marks_;
    };
    const auto sent_since = [this](Time sent) { return sent >= marks_; };
    return std::any_of(acks.late_ce.begin(), acks.late_ce.end(), sent_since) ||
           std::any_of(acks.acked.begin(), acks.acked.end(), is_new);
  }
  /// Marks of packets sent before it have had their reaction.
  Time marks() const { return marks_; }

 private:
  const Parameters& p_;
  Time losses_{};
  Time marks_{};
};

}  // namespace lidar::scream
