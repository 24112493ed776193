// SPDX-License-Identifier: LGPL-2.1-or-later
// Extension gaps: after a gap, restores the state from before it.
#pragma once
#include <algorithm>
#include <optional>
#include <utility>

#include "src/scream/model/path_model.h"
#include "src/scream/parameters.h"

namespace lidar::scream {

/// Restores the window after a gap. A gap is a time in which the link carries almost nothing, for
/// example at a handover or at the edge of a cell. The reductions of the window during a gap say
/// nothing about the link after the gap.
class GapRecovery {
 public:
  struct Restart {
    DataSize window;
    Duration s_rtt{0};
    double l4s_alpha = 0;
  };

  explicit GapRecovery(const Parameters& parameters) : p_(parameters) {}

  /// Call it after each report. Returns the state to continue with if a gap is over.
  std::optional<Restart> Update(Time now, const PathModel& path, DataSize ref_wnd) {
    if (!p_.extensions.gaps) return std::nullopt;
    const auto rate = path.busy_run().latest_capacity();
    if (Slow(rate)) BelieveLess();
    if (path.hole_in_report() || Slow(rate)) NoteSign(now);
    if (!last_sign_) {
      const bool calm = path.queue_delay().qdelay() < path.BusyQdelay(now);
      if (calm) Remember(path, ref_wnd);
      return std::nullopt;
    }
    if (now - *last_sign_ > kLongestMemory || now - first_sign_ > kLongestGap) before_.reset();
    if (!before_) last_sign_.reset();
    if (!last_sign_ || path.hole_in_report()) return std::nullopt;
    const auto window = rate ? Measured(*rate, path) : Unproven(now, path, ref_wnd);
    if (!window) return std::nullopt;
    Restart restart = before_->state;
    restart.window = std::max(ref_wnd, std::min(*window, before_->state.window));
    unproven_ = rate ? std::nullopt : std::optional(restart.window);
    if (rate || restart.window >= before_->state.window * kRestoredPart) last_sign_.reset();
    last_restart_ = now;
    return restart;
  }
  /// Call it while no acknowledgement comes back.
  void OnSilence(Time now) { NoteSign(now); }
  /// Call it after a change of the route, or after a pause of the caller. Forgets the state from
  /// before a gap.
  void Reset() {
    before_.reset();
    last_sign_.reset();
  }

  /// Returns the rate of the remembered window, or nothing if no window is remembered.
  std::optional<DataRate> rate_before() const {
    return before_ ? std::optional(before_->rate) : std::nullopt;
  }
  bool in_gap() const { return last_sign_.has_value(); }

 private:
  struct Before {
    Restart state;
    DataRate rate;
  };
  /// Returns true if `rate`, which the latest arrivals show, is far below the capacity before the
  /// gap.
  bool Slow(std::optional<DataRate> rate) const {
    return before_ && rate && *rate < before_->rate * kGapPart;
  }
  /// Call it if the link is slow again after a window was restored. Lowers the remembered window to
  /// the restored one, and lowers the remembered rate in the same ratio.
  void BelieveLess() {
    const auto tried = std::exchange(unproven_, std::nullopt);
    if (!tried || *tried >= before_->state.window) return;
    before_->rate = before_->rate * (*tried / before_->state.window);
    before_->state.window = *tried;
  }
  void NoteSign(Time now) {
    if (!last_sign_) first_sign_ = now;
    last_sign_ = now;
  }
  void Remember(const PathModel& path, DataSize ref_wnd) {
    unproven_.reset();
    before_ = Before{{ref_wnd, path.rtt().smoothed(), path.l4s_alpha().value()},
                     ref_wnd / path.rtt().smoothed() / p_.target_rate_divisor};
  }
  /// Returns the window for the rate at which packets arrive after the gap, or nothing while this
  /// rate is low.
  std::optional<DataSize> Measured(DataRate rate, const PathModel& path) const {
    if (rate < before_->rate * kGapPart) return std::nullopt;
    return rate * path.rtt().min() * p_.target_rate_divisor;
  }
  /// Returns the next step from `ref_wnd` towards the remembered window, for a time in which no
  /// queue shows the rate of the link. Returns nothing if it is too early for this step.
  std::optional<DataSize> Unproven(Time now, const PathModel& path, DataSize ref_wnd) const {
    // Only the newest packet is checked for a mark, because packets before it may have marks from
    // the gap.
    const bool calm = path.queue_delay().qdelay() < p_.busy_qdelay && !path.newest_marked();
    if (!calm || now - last_restart_ < path.rtt().min()) return std::nullopt;
    return ref_wnd + (before_->state.window - ref_wnd) * kUnprovenPart;
  }

  /// A link that carries less than this part of its earlier capacity is in a gap.
  static constexpr double kGapPart = 0.25;
  /// The state from before a gap is forgotten if the last sign of the gap is older than this.
  static constexpr Duration kLongestMemory = 3s;
  /// A gap that is longer than this shows the new capacity of the link, so the state from before
  /// the gap is forgotten.
  static constexpr Duration kLongestGap = 10s;
  /// The fraction of the missing window that is restored in each round trip, while nothing shows
  /// the rate of the link.
  static constexpr double kUnprovenPart = 0.5;
  static constexpr double kRestoredPart = 0.9;
  const Parameters& p_;
  std::optional<Before> before_;
  std::optional<Time> last_sign_;  // last sign of a gap
  Time first_sign_{};
  Time last_restart_{};
  std::optional<DataSize> unproven_;  // restored window that is not measured yet
};

}  // namespace lidar::scream
