// SPDX-License-Identifier: LGPL-2.1-or-later
// Whether the path carries what is sent: what is in flight, against what comes back.
#pragma once
#include "src/scream/model/path_model.h"
#include "src/scream/model/sent_history.h"
#include "src/scream/response/gap_recovery.h"
#include "src/scream/response/outage.h"

namespace lidar::scream {

/// Remembers nothing itself.
class Liveness {
 public:
  Liveness(const SentHistory& history, const PathModel& path, const Outage& outage,
           const GapRecovery& gaps)
      : history_(history), path_(path), outage_(outage), gaps_(gaps) {}

  /// The path gives a sign of life, or did so a moment ago.
  bool Alive(Time now) const { return outage_.Silence(now) < kLongestSilence; }
  /// What is in flight takes longer than it did: packets wait for the link.
  bool Overdue(Time now) const {
    const auto oldest = history_.oldest_in_flight();
    return oldest && now - *oldest > path_.rtt().smoothed() + Lateness();
  }
  /// What was sent for a while does not come back at the rate that it did: a gap, or the start of
  /// one.
  bool Stalled(Time now) const {
    return gaps_.in_gap() || (Overdue(now) && outage_.Quiet(now) > Lateness());
  }
  /// While packets are overdue, as in a gap: what met the gap takes so long at the rate before it.
  /// What of this has arrived by now still counts.
  Duration WaitBehindGap(Time now) const {
    const auto rate = gaps_.rate_before();
    if (!rate || !Overdue(now)) return Duration{0};
    return path_.max_in_flight().lately() / *rate;
  }

 private:
  /// Silence up to this is one of the gaps that links have.
  static constexpr Duration kLongestSilence = std::chrono::seconds(2);
  /// A packet whose report is so late met a link that stands still.
  static constexpr Duration kOverdue = std::chrono::milliseconds(5);

  /// One report may be lost.
  Duration Lateness() const { return 2 * path_.report_gap() + kOverdue; }

  const SentHistory& history_;
  const PathModel& path_;
  const Outage& outage_;
  const GapRecovery& gaps_;
};

}  // namespace lidar::scream
