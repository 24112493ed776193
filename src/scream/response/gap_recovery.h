// SPDX-License-Identifier: LGPL-2.1-or-later
// Extension gaps: restores the state from before a gap after it.
#pragma once
#include <optional>

#include "src/scream/model/path_model.h"
#include "src/scream/parameters.h"

namespace lidar::scream {

/// A gap is a time in which the link carries almost nothing, as at a handover or the edge of a
/// cell. The window's losses in a gap say nothing about the link after it.
class GapRecovery {
 public:
  struct Restart {
    DataSize window;
    Duration s_rtt{0};
    double l4s_alpha = 0;
  };

  explicit GapRecovery(const Parameters& parameters) : p_(parameters) {}

  /// Call it after each report. Returns where to continue once the gap is over.
  std::optional<Restart> Update(Time now, const PathModel& path, DataSize ref_wnd);
  /// No acknowledgement comes back.
  void OnSilence(Time now) { NoteSign(now); }
  /// Forgets the state before the gap, after another route or an unknown time.
  void Reset() {
    before_.reset();
    last_sign_.reset();
  }

  /// Rate of the remembered window; unset at first.
  std::optional<DataRate> rate_before() const {
    return before_ ? std::optional(before_->rate) : std::nullopt;
  }
  bool in_gap() const { return last_sign_.has_value(); }

 private:
  struct Before {
    Restart state;
    DataRate rate;
  };
  /// Returns true if `rate`, of the latest arrivals, is almost nothing of the earlier capacity.
  bool Slow(std::optional<DataRate> rate) const;
  void BelieveLess();
  void NoteSign(Time now);
  void Remember(const PathModel& path, DataSize ref_wnd);
  /// Returns the window that fits the packets behind the gap.
  std::optional<DataSize> Measured(DataRate rate, const PathModel& path) const;
  /// Returns the next step back if no queue measures the link.
  std::optional<DataSize> Unproven(Time now, const PathModel& path, DataSize ref_wnd) const;

  const Parameters& p_;
  std::optional<Before> before_;
  std::optional<Time> last_sign_;  // of a gap
  Time first_sign_{};
  Time last_restart_{};
  std::optional<DataSize> unproven_;  // window of a step back that is not measured yet
};

}  // namespace lidar::scream
