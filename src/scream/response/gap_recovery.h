// SPDX-License-Identifier: LGPL-2.1-or-later
// Extension gaps: what the path was before a gap is what it is after it.
#pragma once
#include <optional>

#include "src/scream/model/path_model.h"
#include "src/scream/parameters.h"

namespace lidar::scream {

/// A gap is a time in which the link carries next to nothing: a handover, the edge of a cell. What
/// the window loses then says nothing about the link after it.
class GapRecovery {
 public:
  struct Restart {
    DataSize window;
    Duration s_rtt{0};
    double l4s_alpha = 0;
  };

  explicit GapRecovery(const Parameters& parameters) : p_(parameters) {}

  /// After each report. Returns where to go on from, once the gap is over.
  std::optional<Restart> Update(Time now, const PathModel& path, DataSize ref_wnd,
                                Duration qdelay_target);
  /// Nothing comes back at all.
  void OnSilence(Time now) { NoteSign(now); }
  /// What was before is of no use: another route, or time that nobody has seen.
  void Reset() {
    before_.reset();
    last_sign_.reset();
  }

  /// The rate of the window that is remembered. None is at first.
  std::optional<DataRate> rate_before() const {
    return before_ ? std::optional(before_->rate) : std::nullopt;
  }
  bool in_gap() const { return last_sign_.has_value(); }

 private:
  struct Before {
    Restart state;
    DataRate rate;
  };
  /// `rate`, of a train of arrivals, is next to nothing of what the link carried.
  bool Slow(std::optional<DataRate> rate) const;
  void BelieveLess();
  void NoteSign(Time now);
  void Remember(const PathModel& path, DataSize ref_wnd);
  /// The window that fits what the packets behind the gap show.
  std::optional<DataSize> Measured(DataRate rate, const PathModel& path) const;
  /// The next step back where there is no queue to measure the link by.
  std::optional<DataSize> Unproven(Time now, const PathModel& path, DataSize ref_wnd) const;

  const Parameters& p_;
  std::optional<Before> before_;
  std::optional<Time> last_sign_;  // of a gap
  Time first_sign_{};
  Time last_restart_{};
  std::optional<DataSize> unproven_;  // the window of a step back that nothing has measured yet
};

}  // namespace lidar::scream
