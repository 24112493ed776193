// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/effort_control.h"

#include <algorithm>

namespace lidar::codec {
namespace {

constexpr Duration kWindow{1'000'000'000};
constexpr unsigned kFewestSlices = 8;
// The part of a window's slices that may be late, because a machine may be busy for a moment.
constexpr double kLatePart = 0.1;
// A window ends early after this many consecutive slices that take more than twice the allowed
// time.
constexpr unsigned kMuchTooLate = 3;
// A higher effort is tried if it probably needs no more than this part of the allowed time.
constexpr double kRoom = 0.75;
constexpr Duration kFirstHold{4'000'000'000};
constexpr Duration kLongestHold{120'000'000'000};

}  // namespace

void EffortControl::OnSlice(Duration sweep, std::size_t returns, Duration spent) {
  if (sweep <= Duration{0}) return;
  now_ += sweep;
  const double load = Seconds(spent) / (kAllowedPart * Seconds(sweep));
  const auto count = static_cast<double>(returns);
  much_too_late_ = load > 2 ? much_too_late_ + 1 : 0;
  window_.swept += sweep;
  ++window_.slices;
  if (load > 1) ++window_.late;
  window_.spent_s += Seconds(spent);
  window_.returns += count;
  window_.most_returns_per_s = std::max(window_.most_returns_per_s, count / Seconds(sweep));
  const bool is_full = window_.swept >= kWindow && window_.slices >= kFewestSlices;
  if (much_too_late_ < kMuchTooLate && !is_full) return;
  Reconsider(window_.returns > 0 ? window_.spent_s / window_.returns : 0);
  window_ = {};
  much_too_late_ = 0;
}

/// Changes the effort at the end of a window, if necessary. `cost` is the time that the slices of
/// the window took [s per return].
void EffortControl::Reconsider(double cost) {
  LearnRatio(cost);
  if (much_too_late_ >= kMuchTooLate || window_.late > kLatePart * window_.slices) {
    Lower();
    return;
  }
  if (effort_ == kHighest || now_ < levels_[effort_ + 1].not_before) return;
  const double part = cost * levels_[effort_ + 1].ratio * window_.most_returns_per_s;
  if (part > kRoom * kAllowedPart) return;
  cost_below_ = cost;
  ++effort_;
}

/// Updates the ratio of the current level, if this is the first window after a raise. The change is
/// limited, because the machine may have been busy during the window.
void EffortControl::LearnRatio(double cost) {
  if (cost_below_ > 0 && cost > 0) {
    double& ratio = levels_[effort_].ratio;
    ratio = std::clamp(cost / cost_below_, 0.7 * ratio, 1.4 * ratio);
  }
  cost_below_ = 0;
}

void EffortControl::Lower() {
  if (effort_ == 0) return;
  Level& level = levels_[effort_];
  level.hold = std::clamp(2 * level.hold, kFirstHold, kLongestHold);
  level.not_before = now_ + level.hold;
  --effort_;
}

}  // namespace lidar::codec
