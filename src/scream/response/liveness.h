// SPDX-License-Identifier: LGPL-2.1-or-later
// Decides whether the path carries what is sent, from packets in flight and acknowledgements.
#pragma once
#include "src/scream/model/path_model.h"
#include "src/scream/model/sent_history.h"
#include "src/scream/response/gap_recovery.h"
#include "src/scream/response/outage.h"

namespace lidar::scream {

/// Has no state of its own.
class Liveness {
 public:
  Liveness(const SentHistory& history, const PathModel& path, const Outage& outage,
           const GapRecovery& gaps)
      : history_(history), path_(path), outage_(outage), gaps_(gaps) {}

  /// Returns true if acknowledgements come, or came recently.
  bool Alive(Time now) const { return outage_.Silence(now) < kLongestSilence; }
  /// Returns true if packets in flight take longer than before: they wait for the link.
  bool Overdue(Time now) const {
    const auto oldest = history_.oldest_in_flight();
    return oldest && now - *oldest > path_.rtt().smoothed() + Lateness();
  }
  /// Returns true if acknowledgements are slower than packets were sent: a gap, or its start.
  bool Stalled(Time now) const {
    return gaps_.in_gap() || (Overdue(now) && outage_.Quiet(now) > Lateness());
  }
  /// Returns the further delay of the packets that met a gap, at the rate from before it. Some of
  /// them may have arrived by now; they still count.
  Duration WaitBehindGap(Time now) const {
    const auto rate = gaps_.rate_before();
    if (!rate || !Overdue(now)) return Duration{0};
    return path_.max_in_flight().lately() / *rate;
  }

 private:
  /// Longest silence that may be a gap of the link.
  static constexpr Duration kLongestSilence = std::chrono::seconds(2);
  /// A report this late shows a link that stands still.
  static constexpr Duration kOverdue = std::chrono::milliseconds(5);

  /// Allows for one lost report.
  Duration Lateness() const { return 2 * path_.report_gap() + kOverdue; }

  const SentHistory& history_;
  const PathModel& path_;
  const Outage& outage_;
  const GapRecovery& gaps_;
};

}  // namespace lidar::scream
